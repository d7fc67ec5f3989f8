// SPDX-License-Identifier: MIT
#include "device_flags.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

#include "core/text/param_text.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

using darkroom::Result;
using darkroom::user_error;

void DeviceFlags::add_to(CommandFlags command) {
    const std::string group = "The device";
    command.add_option("--device", device_, "Name (or a part of it) or index; see `darkroom devices`")
        .type_name("NAME|INDEX")
        .group(group);
    command.add_option("--kernels", kernels_, "Stage that runs the kernels")
        .type_name("auto|compute|raster")
        .group(group);
    command.add_flag("--no-fuse", is_unfused_, "Gives every effect a pass of its own").group(group);
}

Result<darkroom::KernelStage> DeviceFlags::stage() const {
    if (kernels_ == "auto") return darkroom::KernelStage::Auto;
    if (kernels_ == "compute") return darkroom::KernelStage::Compute;
    if (kernels_ == "raster") return darkroom::KernelStage::Raster;
    return user_error(fmt::format("--kernels {}: allowed is auto, compute or raster", darkroom::printable(kernels_)));
}

Result<darkroom::Device> DeviceFlags::create() const {
    Result<darkroom::Device> device = darkroom::Device::create({.select = device_, .log = log_sink()});
    if (device) remark(fmt::format("device: {}", device->info().name));
    return device;
}

Result<darkroom::Device> DeviceFlags::create_if_named() const {
    return device_.empty() ? darkroom::Device::assumed() : create();
}

Result<darkroom::Device> DeviceFlags::create_compiler() const {
    return darkroom::Device::create({.select = device_, .compiles_only = true, .log = log_sink()});
}

Result<VkExtent2D> parse_size(const std::string& text, std::string_view flag) {
    std::array<std::uint32_t, 2> sides{};
    const char* at = text.data();
    const char* const end = at + text.size();
    for (std::size_t i = 0; i < 2; ++i) {
        const auto [next, error] = std::from_chars(at, end, sides[i]);
        const bool is_done = i == 1 && next == end;
        const bool is_between = i == 0 && next != end && *next == 'x';
        if (error != std::errc() || sides[i] == 0 || !(is_done || is_between))
            return user_error(fmt::format("{} {}: expected WIDTHxHEIGHT in pixels, each at least 1", flag,
                                          darkroom::printable(text)));
        at = next + 1;
    }
    return VkExtent2D{sides[0], sides[1]};
}

Result<darkroom::NewSize> parse_new_size(const std::string& text) {
    // In the order of Sizing.
    const std::vector<std::string> names{"fit", "fill", "stretch"};
    const std::size_t colon = text.find(':');
    const std::string name = colon == std::string::npos ? names.front() : text.substr(colon + 1);
    const auto found = std::ranges::find(names, name);
    if (found == names.end())
        return user_error(fmt::format("--size {}: '{}' is not a way to resize{}", darkroom::printable(text),
                                      darkroom::printable(name), darkroom::alternatives(name, names)));
    DARKROOM_TRY_VALUE(const VkExtent2D size, parse_size(text.substr(0, colon)));
    return darkroom::NewSize{size.width, size.height, static_cast<darkroom::Sizing>(found - names.begin())};
}

Result<darkroom::SampleKind> parse_bits(const std::string& text) {
    if (text == "8") return darkroom::SampleKind::Integer8;
    if (text == "16") return darkroom::SampleKind::Integer16;
    if (text == "half") return darkroom::SampleKind::Half;
    if (text == "float") return darkroom::SampleKind::Float;
    return user_error(fmt::format("--bits {}: allowed is 8, 16, half or float", darkroom::printable(text)));
}

darkroom::DevelopTarget target_for(darkroom::SampleKind samples) {
    if (samples == darkroom::SampleKind::Integer8) return darkroom::DevelopTarget::Encoded8;
    if (samples == darkroom::SampleKind::Integer16) return darkroom::DevelopTarget::EncodedFloat;
    return darkroom::DevelopTarget::SceneLinear;
}

darkroom::DevelopTarget target_for(darkroom::SampleKind samples, const darkroom::WriteOptions& options) {
    return options.view ? darkroom::DevelopTarget::SceneLinear : target_for(samples);
}

darkroom::DevelopTarget target_for(darkroom::VideoFormat format) {
    return format == darkroom::VideoFormat::Rgba64le ? darkroom::DevelopTarget::EncodedFloat
                                                     : darkroom::DevelopTarget::Encoded8;
}

int finish(const darkroom::Device& device, int code) {
    const std::uint64_t messages = device.validation_messages();
    if (messages == 0) return code;
    complain(fmt::format("the validation layer had {} messages", messages));
    return exit_machine;
}

}  // namespace app
