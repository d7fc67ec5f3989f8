// SPDX-License-Identifier: MIT
#include "image/table/resource_file.hpp"

#include "image/frame/frame_file.hpp"
#include "image/picture/picture_numbers.hpp"
#include "image/table/table_file.hpp"

namespace darkroom {

Result<ResourceData> load_resource_file(const std::filesystem::path& path, FileUse use) {
    if (use == FileUse::Table) {
        Result<FoundTable> found = read_table_file(path);
        if (!found) return failure(std::move(found));
        return ResourceData(std::move(found->file.table));
    }
    if (use == FileUse::Numbers) {
        Result<ResourceImage> numbers = read_numbers(path);
        if (!numbers) return failure(std::move(numbers));
        return ResourceData(std::move(*numbers));
    }
    Result<FrameFile> frame =
        read_frame(path, {.has_depth = false, .has_normals = false, .has_velocity = false, .has_shadow_depths = false});
    if (!frame) return failure(std::move(frame));
    return ResourceData(ResourceImage{frame->color.width, frame->color.height, std::move(frame->color.pixels)});
}

}  // namespace darkroom
