// SPDX-License-Identifier: MIT
#pragma once
// Draws SVG documents in a process of its own, darkroom_svg, which alone links librsvg and what comes with it (cairo,
// GLib, fonts): a program that draws none starts no slower, and a document that takes too long, too much memory or
// brings librsvg down costs no more than that process. Started with the first drawing, again after it was lost.

#include <cstdint>
#include <darkroom/hud_document.hpp>
#include <darkroom/result.hpp>
#include <string_view>

#include "confined/process.hpp"

namespace darkroom {

class SvgProcess {
  public:
    explicit SvgProcess(const HudLimits& limits = {}) : limits_(limits) {}

    /// The document fitted to the picture, as its preserveAspectRatio says. The user's errors are one line: librsvg's
    /// own words, with "line N" in them where it names one. The document must have been checked (check_svg).
    [[nodiscard]] Result<HudPicture> draw(std::string_view document, std::uint32_t width, std::uint32_t height);
    /// From any thread, at the end: a drawing that runs fails soon, and so does any other.
    void cancel() { process_.cancel(); }

  private:
    HudLimits limits_;
    ConfinedProcess process_{"darkroom_svg"};
};

}  // namespace darkroom
