// Writes EXR files of several parts, with channels of every type, as other programs make them.
#pragma once

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTiledOutputPart.h>

#include <cstdint>
#include <string>
#include <vector>

namespace cistula::test {

/// A channel of floats, or of whole numbers if there are any.
struct PartChannel {
    std::string name;
    std::vector<float> values;
    std::vector<uint32_t> numbers;
};

struct Part {
    std::string name;
    int width = 0, height = 0;
    std::vector<PartChannel> channels;
    bool tiled = false;
};

/// Each part's data window begins at (3, -2); the display window, which all parts share, is 20 x 10.
inline void write_parts(const std::string& path, const std::vector<Part>& parts) {
    std::vector<Imf::Header> headers;
    for (const Part& part : parts) {
        const Imath::Box2i window({3, -2}, {part.width + 2, part.height - 3});
        Imf::Header header(Imath::Box2i({0, 0}, {19, 9}), window);
        if (parts.size() > 1) header.setName(part.name);
        header.setType(part.tiled ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE);
        if (part.tiled) header.setTileDescription(Imf::TileDescription(2, 2));
        for (const PartChannel& channel : part.channels)
            header.channels().insert(channel.name, Imf::Channel(channel.numbers.empty() ? Imf::FLOAT : Imf::UINT));
        headers.push_back(header);
    }
    Imf::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(parts.size()));
    for (int i = 0; i < static_cast<int>(parts.size()); ++i) {
        const Part& part = parts[static_cast<size_t>(i)];
        Imf::FrameBuffer buffer;
        for (const PartChannel& channel : part.channels)
            buffer.insert(channel.name,
                          channel.numbers.empty()
                              ? Imf::Slice::Make(Imf::FLOAT, channel.values.data(), file.header(i).dataWindow())
                              : Imf::Slice::Make(Imf::UINT, channel.numbers.data(), file.header(i).dataWindow()));
        if (part.tiled) {
            Imf::TiledOutputPart output(file, i);
            output.setFrameBuffer(buffer);
            output.writeTiles(0, output.numXTiles() - 1, 0, output.numYTiles() - 1);
        } else {
            Imf::OutputPart output(file, i);
            output.setFrameBuffer(buffer);
            output.writePixels(part.height);
        }
    }
}

}  // namespace cistula::test
