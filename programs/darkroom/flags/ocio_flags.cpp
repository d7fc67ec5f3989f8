// SPDX-License-Identifier: MIT
#include "ocio_flags.hpp"

#include "image/color/configuration.hpp"

namespace app {

using darkroom::user_error;
using Chain = std::shared_ptr<const darkroom::ColorChain>;

void OcioFlags::add_to(CommandFlags command, bool has_view) {
    const std::string group = has_view ? "The files" : "The frame";
    command.add_option("--ocio", configuration, "A configuration of OpenColorIO (.ocio)")
        .type_name("FILE")
        .group(group);
    if (!has_view) return;
    command.add_option("--display", display_, "Display of it, in place of the look's tone mapping and encoding")
        .type_name("NAME")
        .group(group);
    command.add_option("--view", view_, "A view of that display; default: its usual one")
        .type_name("NAME")
        .group(group);
}

darkroom::Result<> OcioFlags::check(bool has_input_space) const {
    if (configuration.empty() || has_display() || has_input_space) return {};
    DARKROOM_TRY(darkroom::check_configuration(configuration));
    return user_error("--ocio: needs --input-space or --display, which use it");
}

darkroom::Result<Chain> OcioFlags::view(const std::string& input_space) const {
    if (display_.empty()) {
        if (!view_.empty()) return user_error("--view: needs --display NAME");
        return Chain();
    }
    if (configuration.empty()) return user_error("--display: needs --ocio FILE, which defines it");
    return darkroom::view_of_configuration(configuration, display_, view_, input_space);
}

}  // namespace app
