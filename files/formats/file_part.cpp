// SPDX-License-Identifier: MIT
#include "formats/file_part.hpp"

#include <algorithm>

namespace darkroom {

std::string_view name_of(SampleKind kind) {
    switch (kind) {
        case SampleKind::Integer8:
            return "8-bit integer";
        case SampleKind::Integer16:
            return "16-bit integer";
        case SampleKind::Integer32:
            return "32-bit integer";
        case SampleKind::Half:
            return "half";
        case SampleKind::Float:
            return "float";
    }
    return "";
}

std::string one_printable_line(std::string_view text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.remove_suffix(1);
    std::string result(text.substr(0, std::min<std::size_t>(text.find('\n'), 300)));
    for (char& character : result)
        if (character < ' ' || character > '~') character = '?';
    return result;
}

std::size_t size_of(SampleKind kind) {
    switch (kind) {
        case SampleKind::Integer8:
            return 1;
        case SampleKind::Integer16:
        case SampleKind::Half:
            return 2;
        case SampleKind::Integer32:
        case SampleKind::Float:
            return 4;
    }
    return 0;
}

}  // namespace darkroom
