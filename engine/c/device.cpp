// SPDX-License-Identifier: MIT
#include <darkroom/device.hpp>

#include "c/call.hpp"
#include "c/objects.hpp"
#include "gpu/device/context.hpp"

namespace darkroom::c {

namespace {

template <std::size_t Size>
void copy_text(char (&out)[Size], std::string_view text) {
    out[text.copy(out, Size - 1)] = 0;
}

DarkroomDeviceInfo info_of(const DeviceInfo& info) {
    DarkroomDeviceInfo out{};
    out.index = info.index;
    out.api_version = info.api_version;
    out.is_software = info.is_software;
    out.is_null = info.is_null;
    out.is_usable = info.is_usable;
    copy_text(out.name, info.name);
    copy_text(out.driver, info.driver);
    copy_text(out.reason, info.reason);
    return out;
}

LogSink sink_of(DarkroomLog log, void* user) {
    if (log == nullptr) return {};
    return [log, user](Severity severity, std::string_view text) {
        log(user, static_cast<DarkroomSeverity>(severity), std::string(text).c_str());
    };
}

Result<std::span<const std::byte>> bytes_of(const void* data, std::size_t size) {
    if (size > 0 && data == nullptr) return is_null(fmt::format("kernels of {} bytes", size));
    return std::span(static_cast<const std::byte*>(data), data == nullptr ? 0 : size);
}

Result<std::span<const char* const>> names_of(const char* const* names, std::uint32_t count, std::string_view what) {
    if (count > 0 && names == nullptr) return is_null(what);
    if (count > max_elements)
        return user_error(fmt::format("{} {}: allowed are at most {}", count, what, max_elements));
    for (std::uint32_t i = 0; i < count; ++i)
        if (names[i] == nullptr) return is_null(fmt::format("{}[{}]", what, i));
    return std::span(names, count);
}

Result<DeviceDesc> desc_of(const DarkroomDeviceDesc* given) {
    DARKROOM_TRY_VALUE(const auto desc, read_or_default(given, "DarkroomDeviceDesc"));
    DARKROOM_TRY_VALUE(const auto kernels, bytes_of(desc.kernels, desc.kernels_size));
    DARKROOM_TRY_VALUE(const auto instance_extensions,
                       names_of(desc.instance_extensions, desc.instance_extension_count, "instance_extensions"));
    DARKROOM_TRY_VALUE(const auto device_extensions,
                       names_of(desc.device_extensions, desc.device_extension_count, "device_extensions"));
    return DeviceDesc{.select = string(desc.select),
                      .compiles_only = desc.compiles_only != 0,
                      .validate = desc.validate != 0,
                      .log = sink_of(desc.log, desc.log_user),
                      .cache_folder = string(desc.cache_folder),
                      .caches_on_disk = desc.no_caches == 0,
                      .kernels = kernels,
                      .instance_extensions = instance_extensions,
                      .device_extensions = device_extensions};
}

/// A host's own functions for memory behind those of C++, which the device's objects call for as long as they live.
struct Memory {
    DarkroomAllocate allocate;
    DarkroomFree free;
    void* user;
};

VkResult allocate(void* user, VkDevice device, const DeviceMemoryRequest* request, DeviceMemory* memory) {
    const auto& hooks = *static_cast<const Memory*>(user);
    const DarkroomMemoryRequest asked{.struct_size = sizeof(DarkroomMemoryRequest),
                                      .memory_type = request->memory_type,
                                      .size = request->size,
                                      .alignment = request->alignment,
                                      .image = request->image,
                                      .buffer = request->buffer,
                                      .is_mapped = request->is_mapped,
                                      .prefers_dedicated = request->prefers_dedicated,
                                      .requires_dedicated = request->requires_dedicated};
    DarkroomMemory given{};
    given.struct_size = sizeof given;
    const VkResult result = hooks.allocate(hooks.user, device, &asked, &given);
    *memory = {.memory = given.memory, .offset = given.offset, .mapped = given.mapped, .owner = given.owner};
    return result;
}

void release(void* user, VkDevice device, const DeviceMemory* memory) {
    const auto& hooks = *static_cast<const Memory*>(user);
    const DarkroomMemory given{.struct_size = sizeof(DarkroomMemory),
                               .memory = memory->memory,
                               .offset = memory->offset,
                               .mapped = memory->mapped,
                               .owner = memory->owner};
    hooks.free(hooks.user, device, &given);
}

}  // namespace

}  // namespace darkroom::c

using namespace darkroom;
using namespace darkroom::c;

DarkroomResult darkroom_device_list(DarkroomDeviceInfo* infos, uint32_t* count) {
    return call("darkroom_device_list", [&]() -> Result<> {
        DARKROOM_TRY(needs("count", count));
        DARKROOM_TRY_VALUE(auto all, Device::list());
        const auto room = infos == nullptr ? 0 : std::min<std::size_t>(*count, all.size());
        for (std::size_t i = 0; i < room; ++i) DARKROOM_TRY(write_at(infos, i, info_of(all[i]), "DarkroomDeviceInfo"));
        *count = static_cast<std::uint32_t>(all.size());
        return {};
    });
}

DarkroomResult darkroom_device_create(const DarkroomDeviceDesc* desc, DarkroomDevice* device) {
    return call("darkroom_device_create", [&]() -> Result<> {
        DARKROOM_TRY(needs("device", device));
        DARKROOM_TRY_VALUE(const auto read_desc, desc_of(desc));
        DARKROOM_TRY_VALUE(auto made, Device::create(read_desc));
        *device = new DarkroomDeviceObject{std::move(made)};
        return {};
    });
}

DarkroomResult darkroom_device_assumed(DarkroomDeviceProfile profile, DarkroomDevice* device) {
    return call("darkroom_device_assumed", [&]() -> Result<> {
        DARKROOM_TRY(needs("device", device));
        DARKROOM_TRY_VALUE(const auto kind,
                           enumerator<DeviceProfile>(profile, DARKROOM_DEVICE_PROFILE_SOFTWARE, "profile"));
        *device = new DarkroomDeviceObject{Device::assumed(kind)};
        return {};
    });
}

DarkroomResult darkroom_device_adopt(const DarkroomAdoptDesc* given, DarkroomDevice* device) {
    return call("darkroom_device_adopt", [&]() -> Result<> {
        DARKROOM_TRY(needs("desc", given, "device", device));
        DARKROOM_TRY_VALUE(const auto desc, read(given, "DarkroomAdoptDesc"));
        DARKROOM_TRY_VALUE(const auto kernels, bytes_of(desc.kernels, desc.kernels_size));
        DARKROOM_TRY_VALUE(const auto instance_extensions,
                           names_of(desc.enabled_instance_extensions, desc.enabled_instance_extension_count,
                                    "enabled_instance_extensions"));
        DARKROOM_TRY_VALUE(
            const auto device_extensions,
            names_of(desc.enabled_device_extensions, desc.enabled_device_extension_count, "enabled_device_extensions"));
        if ((desc.allocate == nullptr) != (desc.free == nullptr))
            return user_error("allocate and free: one is null; allowed are both or none");
        AdoptDesc adopt{.instance = desc.instance,
                        .physical_device = desc.physical_device,
                        .device = desc.device,
                        .queue_family = desc.queue_family,
                        .enabled_features = desc.enabled_features,
                        .enabled_instance_extensions = instance_extensions,
                        .enabled_device_extensions = device_extensions,
                        .get_proc = desc.get_proc,
                        .log = sink_of(desc.log, desc.log_user),
                        .cache_folder = string(desc.cache_folder),
                        .caches_on_disk = desc.no_caches == 0,
                        .kernels = kernels,
                        .pipeline_cache = desc.pipeline_cache,
                        .allocator = desc.allocator};
        if (desc.api_version != 0) adopt.api_version = desc.api_version;
        std::shared_ptr<Memory> memory;
        if (desc.allocate != nullptr) {
            memory = std::make_shared<Memory>(Memory{desc.allocate, desc.free, desc.memory_user});
            adopt.memory = {.allocate = allocate, .free = release, .user = memory.get()};
        }
        DARKROOM_TRY_VALUE(auto made, Device::adopt(adopt));
        made.context().memory_hooks_owner = std::move(memory);
        *device = new DarkroomDeviceObject{std::move(made)};
        return {};
    });
}

void darkroom_device_destroy(DarkroomDevice device) { delete device; }

DarkroomResult darkroom_device_info(DarkroomDevice device, DarkroomDeviceInfo* info) {
    return call("darkroom_device_info", [&]() -> Result<> {
        DARKROOM_TRY(needs("device", device, "info", info));
        return write(info, info_of(device->device.info()), "DarkroomDeviceInfo");
    });
}

DarkroomResult darkroom_device_validation_messages(DarkroomDevice device, uint64_t* count) {
    return call("darkroom_device_validation_messages", [&]() -> Result<> {
        DARKROOM_TRY(needs("device", device, "count", count));
        *count = device->device.validation_messages();
        return {};
    });
}
