#include "renderer/core/atomic_file.h"
#include "renderer/core/error.h"
#include "renderer/core/image.h"
#include "renderer/core/input_file.h"
#include "renderer/core/parallel.h"

#include <ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <OpenEXR/ImfVersion.h>
#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

namespace rapport {
namespace {

// Bounds on what is allocated on a header's word. The second is far above what the codecs reach
// on a constant picture, and keeps a damaged small file from asking for gigabytes.
constexpr int kMaxExtent = 1 << 17;
constexpr uint64_t kMaxSamples = uint64_t{1} << 31;
constexpr uint64_t kMaxSamplesPerByte = 1 << 16;

/// The header of a flat picture of one part and of sane size; anything else is a FileError.
const Imf::Header& checked_header(const Imf::MultiPartInputFile& file, uint64_t file_size,
                                  const std::string& path) {
    if (file.parts() != 1)
        throw FileError(path, "", "an EXR of one part", fmt::format("{} parts", file.parts()));
    const Imf::Header& header = file.header(0);
    if (header.hasType() && !Imf::isImage(header.type()))
        throw FileError(path, "", "an EXR of flat pixels", "deep pixels");

    uint64_t channels = 0;
    for (auto i = header.channels().begin(); i != header.channels().end(); ++i, ++channels)
        if (i.channel().xSampling != 1 || i.channel().ySampling != 1)
            throw FileError(path, i.name(), "a channel with every pixel", "a subsampled one");
    if (channels == 0)
        throw FileError(path, "", "at least one channel", "none");

    const Imath::Box2i window = header.dataWindow();
    const int64_t width = int64_t{window.max.x} - window.min.x + 1;
    const int64_t height = int64_t{window.max.y} - window.min.y + 1;
    if (width < 1 || height < 1 || width > kMaxExtent || height > kMaxExtent ||
        width * height * channels > std::min(kMaxSamples, file_size * kMaxSamplesPerByte))
        throw FileError(path, "", "a picture of a size that the file can hold",
                        fmt::format("{} × {} pixels with {} channels in {} bytes", width, height,
                                    channels, file_size));
    return header;
}

Image read_pixels(Imf::MultiPartInputFile& file, const Imf::Header& header,
                  const std::string& path) {
    const Imath::Box2i window = header.dataWindow();
    std::vector<std::string> channels;
    for (auto i = header.channels().begin(); i != header.channels().end(); ++i)
        channels.emplace_back(i.name());
    Image image(window.max.x - window.min.x + 1, window.max.y - window.min.y + 1,
                std::move(channels));
    for (auto i = header.begin(); i != header.end(); ++i)
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&i.attribute()))
            if (std::string_view(i.name()) != "type" && std::string_view(i.name()) != "name")
                image.attributes[i.name()] = text->value();

    Imf::FrameBuffer frame;
    for (size_t c = 0; c < image.channels.size(); ++c)
        frame.insert(image.channels[c], Imf::Slice::Make(Imf::FLOAT, image.data[c].data(), window));
    Imf::InputPart part(file, 0);
    part.setFrameBuffer(frame);
    try {
        part.readPixels(window.min.y, window.max.y);
    } catch (const std::exception& error) {
        throw FileError(path, "", "complete scan lines",
                        std::string("truncated or damaged pixels (") + error.what() + ")");
    }
    return image;
}

} // namespace

Image read_exr(const std::filesystem::path& path) {
    InputFile input = open_input(path);
    char magic[4] = {};
    input.stream.read(magic, sizeof magic);
    if (!input.stream || !Imf::isImfMagic(magic))
        throw FileError(path.string(), "", "an OpenEXR file", "another kind of file");
    input.stream.seekg(0);
    try {
        Imf::StdIFStream stream(input.stream, path.c_str());
        Imf::MultiPartInputFile file(stream, 0, false);
        return read_pixels(file, checked_header(file, input.size, path.string()), path.string());
    } catch (const FileError&) {
        throw;
    } catch (const std::exception& error) {
        throw FileError(path.string(), "", "a whole OpenEXR file",
                        std::string("a truncated or damaged one (") + error.what() + ")");
    }
}

void write_exr(const Image& image, const std::filesystem::path& path) {
    const size_t pixels = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
    if (image.width < 1 || image.height < 1 || image.channels.empty() ||
        image.data.size() != image.channels.size())
        throw std::invalid_argument("an image without pixels or channels cannot be written");
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const auto& [name, text] : image.attributes)
        header.insert(name, Imf::StringAttribute(text));

    Imf::FrameBuffer frame;
    for (size_t c = 0; c < image.channels.size(); ++c) {
        if (image.data[c].size() != pixels)
            throw std::invalid_argument("channel " + image.channels[c] + " has the wrong size");
        header.channels().insert(image.channels[c], Imf::Channel(Imf::FLOAT));
        frame.insert(image.channels[c],
                     Imf::Slice::Make(Imf::FLOAT, image.data[c].data(), header.dataWindow()));
    }
    if (Imf::globalThreadCount() != thread_count()) // lines are compressed by all of them
        Imf::setGlobalThreadCount(thread_count());
    write_stream_atomically(path, [&](std::ofstream& output) {
        Imf::StdOFStream stream(output, path.c_str());
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(frame);
        try {
            file.writePixels(image.height);
        } catch (const std::exception& error) {
            throw FileError(path.string(), "", "room for the whole file", error.what());
        }
    });
}

} // namespace rapport
