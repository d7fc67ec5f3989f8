// SPDX-License-Identifier: MIT
#include "image/table/resource_file.hpp"

#include <fmt/format.h>

#include "core/text/param_text.hpp"
#include "image/frame/frame_file.hpp"
#include "image/picture/picture_numbers.hpp"
#include "image/table/table_file.hpp"

namespace darkroom {

Result<ResourceData> load_resource_file(const std::filesystem::path& path, FileUse use,
                                        std::vector<std::string>& warnings) {
    const auto tell = [&](std::span<const std::string> lines) {
        for (const std::string& line : lines) warnings.push_back(fmt::format("{}: {}", printable(path.string()), line));
    };
    if (use == FileUse::Table) {
        DARKROOM_TRY_VALUE(FoundTable found, read_table_file(path));
        tell(found.warnings);
        return ResourceData(std::move(found.file.table));
    }
    if (use == FileUse::Numbers) {
        std::string left_out;
        DARKROOM_TRY_VALUE(ResourceImage numbers, read_numbers(path, nullptr, &left_out));
        if (!left_out.empty()) tell({&left_out, 1});
        return ResourceData(std::move(numbers));
    }
    DARKROOM_TRY_VALUE(
        FrameFile frame,
        read_frame(path,
                   {.has_depth = false, .has_normals = false, .has_velocity = false, .has_shadow_depths = false}));
    tell(frame.warnings);
    return ResourceData(ResourceImage{frame.color.width, frame.color.height, std::move(frame.color.pixels)});
}

}  // namespace darkroom
