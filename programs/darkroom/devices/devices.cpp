// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <darkroom/device.hpp>
#include <memory>

#include "programs/darkroom/commands.hpp"
#include "programs/darkroom/run/json.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

namespace {

const char* kind_of(const darkroom::DeviceInfo& device) {
    if (device.is_null) return "null";
    return device.is_software ? "software" : "hardware";
}

std::string vulkan_of(const darkroom::DeviceInfo& device) {
    return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(device.api_version), VK_API_VERSION_MINOR(device.api_version),
                       VK_API_VERSION_PATCH(device.api_version));
}

std::string document_of(const std::vector<darkroom::DeviceInfo>& devices) {
    Json out = Json::array();
    for (const darkroom::DeviceInfo& device : devices) {
        Json row{{"index", device.index},       {"name", device.name},     {"driver", device.driver},
                 {"vulkan", vulkan_of(device)}, {"kind", kind_of(device)}, {"usable", device.is_usable}};
        if (!device.is_usable) row["reason"] = device.reason;
        out.push_back(std::move(row));
    }
    return out.dump(1);
}

int list(bool is_json) {
    const darkroom::Result<std::vector<darkroom::DeviceInfo>> devices = darkroom::Device::list();
    if (!devices) return fail(devices.error());
    if (is_json) answer(document_of(*devices));
    for (const darkroom::DeviceInfo& device : is_json ? std::vector<darkroom::DeviceInfo>() : *devices)
        answer(fmt::format("{}: {} | {} | Vulkan {} | {}{}", device.index, device.name, device.driver,
                           vulkan_of(device), kind_of(device),
                           device.is_usable ? "" : fmt::format(" | not usable: {}", device.reason)));
    if (!devices->empty()) return exit_ok;
    complain("devices: there is no Vulkan device; the software driver is in the package mesa-vulkan-drivers");
    return exit_machine;
}

}  // namespace

static Command add_devices(CommandFlags program) {
    const CommandFlags command = program.add_command("devices", "Lists the Vulkan devices, best first");
    command.examples(
        "darkroom devices\n"
        "darkroom devices --json\n"
        "darkroom develop frame.exr --device 0 -o picture.png");
    const auto is_json = std::make_shared<bool>();
    command.add_flag("--json", *is_json, "For programs: an array, one object a device");
    return {command, [is_json] { return list(*is_json); }};
}

CommandRow devices_command() {
    return {.names = {"devices"}, .place = 100, .add = [](const CommandHost& host) {
                return std::vector{add_devices(host.program)};
            }};
}

}  // namespace app
