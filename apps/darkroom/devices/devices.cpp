// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <darkroom/device.hpp>

#include "apps/darkroom/commands.hpp"
#include "apps/darkroom/run/report.hpp"

namespace app {

namespace {

const char* kind_of(const darkroom::DeviceInfo& device) {
    if (device.is_null) return "null";
    return device.is_software ? "software" : "hardware";
}

int list() {
    const darkroom::Result<std::vector<darkroom::DeviceInfo>> devices = darkroom::Device::list();
    if (!devices) return fail(devices.error());
    for (const darkroom::DeviceInfo& device : *devices) {
        fmt::print("{}: {} | {} | Vulkan {}.{}.{} | {}{}\n", device.index, device.name, device.driver,
                   VK_API_VERSION_MAJOR(device.api_version), VK_API_VERSION_MINOR(device.api_version),
                   VK_API_VERSION_PATCH(device.api_version), kind_of(device),
                   device.is_usable ? "" : fmt::format(" | not usable: {}", device.reason));
    }
    if (!devices->empty()) return exit_ok;
    complain("devices: there is no Vulkan device; the software driver is in the package mesa-vulkan-drivers");
    return exit_machine;
}

}  // namespace

Command add_devices(CommandFlags program) {
    const CommandFlags command = program.add_command("devices", "Lists the Vulkan devices, best first");
    command.examples(
        "darkroom devices\n"
        "darkroom develop frame.exr --device 0 -o picture.png\n"
        "DARKROOM_VALIDATE=1 darkroom develop frame.exr -o picture.png");
    return {command, list};
}

}  // namespace app
