#pragma once

#include <filesystem>
#include <string>
#include <tiny_gltf.h>
#include <vector>

namespace rapport {

/// Parses a `.gltf` or `.glb` with its buffers and images. Images of data URIs and files of their
/// own stay encoded; those that are missing are empty. Whatever tinygltf would read past, recurse
/// into without end, or quietly take for a default is refused before it sees it: GLB chunks that
/// overrun the file, JSON nested too deep, indices, sizes and transforms of the wrong kind. So are
/// required extensions that change the geometry in ways not known here; harmless ones become
/// warnings. FileError for everything that is wrong.
tinygltf::Model load_gltf_file(const std::filesystem::path& path,
                               std::vector<std::string>& warnings);

} // namespace rapport
