// SPDX-License-Identifier: MIT
#pragma once
// What a judgement says: as lines, as JSON, and as a web page with the pictures beside it.

#include <optional>
#include <string>
#include <vector>

#include "image/judge/judge.hpp"
#include "image/judge/slanted_edge.hpp"
#include "programs/darkroom/run/json.hpp"

namespace app {

struct Judgement {
    std::string truth, test;  ///< folders
    darkroom::Verdict verdict;
    std::uint32_t width = 0, height = 0;
    struct Edge {
        darkroom::EdgeSharpness truth, test;
    };
    std::optional<Edge> edge;
};

[[nodiscard]] std::string text_of(const Judgement& judgement);
[[nodiscard]] Json json_of(const Judgement& judgement);

/// Pictures of a frame, beside the page.
[[nodiscard]] std::string picture_name(std::string_view kind, long long number);
/// A page that needs nothing but the pictures truth.####.png, test.####.png and error.####.png of these frames.
[[nodiscard]] std::string page_of(const Judgement& judgement);

}  // namespace app
