// SPDX-License-Identifier: MIT
#include "formats/file_format.hpp"

namespace darkroom {

std::string format_names() {
    std::string out;
    for (const FileFormat* const format : all_formats()) {
        if (!out.empty()) out += ", ";
        out += format->name;
    }
    return out;
}

std::vector<std::string> picture_extensions() {
    std::vector<std::string> out;
    for (const FileFormat* const format : all_formats())
        out.insert(out.end(), format->extensions.begin(), format->extensions.end());
    return out;
}

std::string written_extensions(bool (*is)(const FileFormat& format)) {
    std::string out;
    for (const FileFormat* const format : all_formats()) {
        if (format->samples.empty() || (is != nullptr && !is(*format))) continue;
        if (!out.empty()) out += " ";
        out += format->extensions.front();
    }
    return out;
}

}  // namespace darkroom
