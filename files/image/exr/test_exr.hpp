// SPDX-License-Identifier: MIT
#pragma once
// For tests: OpenEXR files whose numbers are written as they are, finite or not.

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace darkroom::test {

/// All channels of a pixel, then the next, rows from the top. `change`: what else the file says.
inline void store_floats(const std::filesystem::path& path, const std::vector<std::string>& channels, std::size_t width,
                         std::span<const float> values, const std::function<void(Imf::Header&)>& change = {}) {
    const std::size_t pixel = channels.size() * sizeof(float);
    const auto height = static_cast<int>(values.size() / channels.size() / width);
    Imf::Header header(static_cast<int>(width), height);
    if (change) change(header);
    Imf::FrameBuffer buffer;
    for (std::size_t i = 0; i < channels.size(); ++i) {
        header.channels().insert(channels[i], Imf::Channel(Imf::FLOAT));
        // Slices begin at the origin of the file's coordinates, which need not lie in the window.
        const auto first = reinterpret_cast<std::uintptr_t>(&values[i]) -
                           static_cast<std::size_t>(header.dataWindow().min.x) * pixel -
                           static_cast<std::size_t>(header.dataWindow().min.y) * width * pixel;
        buffer.insert(channels[i], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(first), pixel, width * pixel));
    }
    Imf::OutputFile output(path.c_str(), header);
    output.setFrameBuffer(buffer);
    output.writePixels(height);
}

}  // namespace darkroom::test
