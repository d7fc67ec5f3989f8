// SPDX-License-Identifier: MIT
#pragma once
// The flags that take colours from a configuration of OpenColorIO: the space that a frame is in, and the view of a
// display that the picture is made for.

#include <darkroom/result.hpp>
#include <memory>
#include <string>

#include "flags.hpp"
#include "image/table/color_chain.hpp"

namespace app {

/// --ocio, --display, --view.
class OcioFlags {
  public:
    void add_to(CommandFlags command, bool has_view);
    /// Null: no display was named. `input_space`: of the frame, whose numbers a view of data shows. Errors: a display
    /// without a configuration, and what the configuration lacks.
    [[nodiscard]] darkroom::Result<std::shared_ptr<const darkroom::ColorChain>> view(
        const std::string& input_space) const;

    /// A configuration that nothing asks for is an error.
    [[nodiscard]] darkroom::Result<> check(bool has_input_space) const;
    [[nodiscard]] bool has_display() const { return !display_.empty(); }

    std::string configuration;  ///< empty: none

  private:
    std::string display_, view_;
};

}  // namespace app
