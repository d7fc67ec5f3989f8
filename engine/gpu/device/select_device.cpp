// SPDX-License-Identifier: MIT
#include "gpu/device/select_device.hpp"

#include "core/text/lower.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>
#include <vector>

namespace darkroom::gpu {

namespace {

std::optional<std::uint32_t> as_index(const std::string& text) {
    std::uint32_t index = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, index);
    if (error != std::errc() || stop != end) return {};
    return index;
}

std::string names_of(std::span<const DeviceInfo> infos) {
    std::vector<std::string> names;
    for (const DeviceInfo& info : infos) names.push_back(fmt::format("{} \"{}\"", info.index, info.name));
    return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

Failure no_device(const std::string& why) {
    return machine_error("no Vulkan device: the loader found no driver" + why +
                             "; Mesa's software driver is in the package mesa-vulkan-drivers",
                         ErrorCode::Unsupported);
}

Result<std::size_t> select_device(std::span<const DeviceInfo> infos, const std::string& select) {
    if (infos.empty()) return no_device();
    const std::optional<std::uint32_t> index = as_index(select);
    const auto place = [&](auto found) { return static_cast<std::size_t>(found - infos.begin()); };
    if (index) {
        const auto found = std::ranges::find(infos, *index, &DeviceInfo::index);
        if (found != infos.end()) return place(found);
    }
    const std::string part = lower(select);
    const auto found = std::ranges::find_if(
        infos, [&](const DeviceInfo& info) { return lower(info.name).find(part) != std::string::npos; });
    if (found != infos.end()) return place(found);
    return user_error(fmt::format("device \"{}\": {}; there are {}", select,
                                  index ? "no device has this index or a name with this in it" : "no such device",
                                  names_of(infos)));
}

}  // namespace darkroom::gpu
