// SPDX-License-Identifier: MIT
#include "c/frame_of.hpp"

using namespace darkroom;
using namespace darkroom::c;

DarkroomResult darkroom_kernel_file_create(DarkroomKernelFile* file) {
    return call("darkroom_kernel_file_create", [&]() -> Result<> {
        DARKROOM_TRY(needs("file", file));
        *file = new DarkroomKernelFileObject{};
        return {};
    });
}

void darkroom_kernel_file_destroy(DarkroomKernelFile file) { delete file; }

DarkroomResult darkroom_kernel_file_add(DarkroomKernelFile file, DarkroomComposer composer,
                                        const DarkroomCompileDesc* given) {
    return call("darkroom_kernel_file_add", [&]() -> Result<> {
        DARKROOM_TRY(needs("file", file, "composer", composer, "desc", given));
        DARKROOM_TRY_VALUE(const auto desc, compile_desc_of(given));
        return file->file.add(composer->composer, desc);
    });
}

DarkroomResult darkroom_kernel_file_size(DarkroomKernelFile file, uint32_t* count) {
    return call("darkroom_kernel_file_size", [&]() -> Result<> {
        DARKROOM_TRY(needs("file", file, "count", count));
        *count = static_cast<std::uint32_t>(file->file.size());
        return {};
    });
}

DarkroomResult darkroom_kernel_file_bytes(DarkroomKernelFile file, const void** bytes, size_t* size) {
    return call("darkroom_kernel_file_bytes", [&]() -> Result<> {
        DARKROOM_TRY(needs("file", file, "bytes", bytes, "size", size));
        file->bytes = file->file.bytes();
        *bytes = file->bytes.data();
        *size = file->bytes.size();
        return {};
    });
}
