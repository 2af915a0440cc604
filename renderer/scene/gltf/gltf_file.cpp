#include "renderer/scene/gltf/gltf_file.h"

#include "renderer/core/error.h"
#include "renderer/scene/file_bytes.h"
#include "renderer/scene/gltf/gltf_json.h"

#include <bit>
#include <cstring>
#include <fmt/format.h>

namespace rapport {
namespace {

constexpr uint32_t kMagic = 0x46546c67;     // "glTF"
constexpr uint32_t kJsonChunk = 0x4e4f534a; // "JSON"
constexpr size_t kHeaderSize = 12, kChunkHeaderSize = 8;

uint32_t word_at(const std::vector<char>& file, size_t offset) {
    uint32_t word;
    std::memcpy(&word, file.data() + offset, sizeof word);
    if constexpr (std::endian::native == std::endian::big)
        word = __builtin_bswap32(word);
    return word;
}

bool is_glb(const std::vector<char>& file) {
    return file.size() >= sizeof kMagic && word_at(file, 0) == kMagic;
}

/// The JSON chunk of a GLB, after checking that all chunks lie in the file.
std::string_view glb_json(const std::vector<char>& file, const std::string& path) {
    if (file.size() < kHeaderSize + kChunkHeaderSize)
        throw FileError(path, "header", "20 bytes or more", fmt::format("{}", file.size()));
    if (word_at(file, 4) != 2)
        throw FileError(path, "header", "GLB version 2", fmt::format("{}", word_at(file, 4)));
    const size_t length = word_at(file, 8);
    if (length > file.size() || length < kHeaderSize + kChunkHeaderSize)
        throw FileError(path, "header", fmt::format("a length from 20 to {} bytes", file.size()),
                        fmt::format("{}", length));
    if (word_at(file, 16) != kJsonChunk)
        throw FileError(path, "chunk 0", "the JSON chunk", "another");
    size_t offset = kHeaderSize;
    for (int chunk = 0; offset < length; ++chunk) {
        const size_t room = length - offset;
        if (room < kChunkHeaderSize || word_at(file, offset) > room - kChunkHeaderSize)
            throw FileError(path, fmt::format("chunk {}", chunk), "a chunk that ends in the file",
                            fmt::format("{} bytes left", room));
        offset += kChunkHeaderSize + word_at(file, offset);
    }
    return {file.data() + kHeaderSize + kChunkHeaderSize, word_at(file, kHeaderSize)};
}

/// Only files beside the glTF, and nothing that could block or be expanded by a shell.
tinygltf::FsCallbacks plain_file_access() {
    tinygltf::FsCallbacks access{};
    access.FileExists = [](const std::string& name, void*) {
        // tinygltf also looks in the current directory, which would be another file by chance.
        const std::filesystem::path file(name);
        std::error_code error;
        return file.is_absolute() && std::filesystem::is_regular_file(file, error);
    };
    access.ExpandFilePath = [](const std::string& name, void*) { return name; };
    access.ReadWholeFile = [](std::vector<unsigned char>* bytes, std::string* message,
                              const std::string& name, void*) {
        try {
            const std::vector<char> file = read_file(name);
            bytes->assign(file.begin(), file.end());
            return true;
        } catch (const FileError& error) {
            *message += error.what();
            return false;
        }
    };
    return access;
}

/// Images in bufferViews are left to GltfAccessors, because what tinygltf passes for those may lie
/// beyond the buffer.
bool keep_encoded(tinygltf::Image* image, int, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void*) {
    if (image->bufferView < 0)
        image->image.assign(bytes, bytes + size);
    image->as_is = true;
    return true;
}

void append_word(std::vector<char>& to, size_t value) {
    for (int shift = 0; shift < 32; shift += 8)
        to.push_back(static_cast<char>(value >> shift));
}

/// Accessors may do without a bufferView: their values are 0 where no sparse ones stand. tinygltf
/// refuses such indices, so that it is shown a view of nothing instead; `release` takes it away.
class ViewlessAccessors {
  public:
    explicit ViewlessAccessors(nlohmann::json& root) {
        for (size_t i = 0; i < root.value("accessors", nlohmann::json::array()).size(); ++i)
            if (!root["accessors"][i].contains("bufferView"))
                accessors_.push_back(i);
        if (accessors_.empty())
            return;
        nlohmann::json& views = root["bufferViews"];
        for (const size_t i : accessors_)
            root["accessors"][i]["bufferView"] = views.size();
        views.push_back({{"buffer", 0}, {"byteLength", 1}});
    }
    bool empty() const { return accessors_.empty(); }

    void release(tinygltf::Model& model) const {
        if (empty())
            return;
        for (const size_t i : accessors_)
            model.accessors.at(i).bufferView = -1;
        model.bufferViews.pop_back();
    }

  private:
    std::vector<size_t> accessors_;
};

/// The file with other JSON; what follows the JSON chunk of a GLB is kept.
std::vector<char> with_json(const std::vector<char>& file, bool binary, std::string json) {
    if (!binary)
        return {json.begin(), json.end()};
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const size_t rest = kHeaderSize + kChunkHeaderSize + word_at(file, kHeaderSize);
    const size_t end = word_at(file, 8);
    std::vector<char> changed(file.begin(), file.begin() + 8);
    append_word(changed, kHeaderSize + kChunkHeaderSize + json.size() + (end - rest));
    append_word(changed, json.size());
    append_word(changed, kJsonChunk);
    changed.insert(changed.end(), json.begin(), json.end());
    changed.insert(changed.end(), file.begin() + static_cast<ptrdiff_t>(rest),
                   file.begin() + static_cast<ptrdiff_t>(end));
    return changed;
}

std::string one_line(std::string text) {
    text.erase(text.find_last_not_of(" \n\r") + 1);
    constexpr size_t kMostOfData = 60; // its media type, and what follows
    if (const size_t data = text.find("data:");
        data != std::string::npos && text.size() > data + kMostOfData)
        text = text.substr(0, data + kMostOfData) + "…";
    for (char& c : text)
        c = c == '\n' || c == '\r' ? ' ' : c;
    return text;
}

/// Every buffer has its bytes somewhere; the first of a GLB may have them in the file itself.
void check_buffers(const nlohmann::json& root, bool binary, const std::string& path) {
    const nlohmann::json buffers = root.value("buffers", nlohmann::json::array());
    for (size_t i = binary ? 1 : 0; i < buffers.size(); ++i)
        if (!buffers[i].contains("uri"))
            throw FileError(path, fmt::format("buffers[{}].uri", i), "a file or data", "none");
}

/// The buffer whose uri tinygltf's message quotes, or nothing.
std::string place_of(const std::string& message, const nlohmann::json& root) {
    const nlohmann::json buffers = root.value("buffers", nlohmann::json::array());
    for (size_t i = 0; i < buffers.size(); ++i)
        if (const nlohmann::json uri = buffers[i].value("uri", nlohmann::json());
            uri.is_string() && !uri.get_ref<const std::string&>().empty() &&
            message.find(uri.get_ref<const std::string&>()) != std::string::npos)
            return fmt::format("buffers[{}].uri", i);
    return "";
}

} // namespace

tinygltf::Model load_gltf_file(const std::filesystem::path& path,
                               std::vector<std::string>& warnings) {
    std::vector<char> file = read_file(path);
    const std::string name = path.string();
    if (file.size() > std::numeric_limits<uint32_t>::max())
        throw FileError(name, "", "less than 4 GB", fmt::format("{} bytes", file.size()));
    const bool binary = is_glb(file);
    if (!binary && path.extension() == ".glb")
        throw FileError(name, "header", "'glTF'", "another beginning");
    nlohmann::json root = read_gltf_json(
        binary ? glb_json(file, name) : std::string_view(file.data(), file.size()), name, warnings);
    check_buffers(root, binary, name);
    const ViewlessAccessors viewless(root);
    if (!viewless.empty())
        file = with_json(file, binary, root.dump());

    tinygltf::TinyGLTF loader;
    loader.SetFsCallbacks(plain_file_access());
    loader.SetImageLoader(keep_encoded, nullptr);
    const std::string folder = std::filesystem::absolute(path).parent_path().string();
    const auto size = static_cast<unsigned int>(file.size());
    tinygltf::Model model;
    std::string error, unused; // tinygltf's warnings are about images
    bool loaded = false;
    try {
        loaded =
            binary
                ? loader.LoadBinaryFromMemory(&model, &error, &unused,
                                              reinterpret_cast<const unsigned char*>(file.data()),
                                              size, folder)
                : loader.LoadASCIIFromString(&model, &error, &unused, file.data(), size, folder);
    } catch (const std::exception& exception) {
        error = exception.what();
    }
    if (!loaded)
        throw FileError(name, place_of(error, root), "a valid glTF 2.0 file", one_line(error));
    viewless.release(model);
    return model;
}

} // namespace rapport
