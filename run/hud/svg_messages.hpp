// SPDX-License-Identifier: MIT
#pragma once
// What a program and its darkroom_svg say to each other, over the socket that is the latter's standard input: a request
// with memory for the picture, and the document's bytes; a reply and the bytes of an error's text. The picture is RGBA
// of 8 bits, premultiplied, rows from the top.

#include <cstdint>

namespace darkroom {

struct SvgRequest {
    std::uint32_t document_size = 0;  ///< bytes
    std::uint32_t width = 0, height = 0;
    std::uint32_t max_seconds = 0;  ///< after which darkroom_svg ends itself
};
struct SvgReply {
    std::uint32_t error_size = 0;  ///< bytes; 0: the pixels are there
};

}  // namespace darkroom
