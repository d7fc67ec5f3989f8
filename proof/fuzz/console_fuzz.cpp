// SPDX-License-Identifier: MIT
// Commands of the console, and files of its configuration: whatever is said,
// values stay in their ranges, and a variable that is set to the text that it
// shows stays what it is.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fuzz/target.hpp"
#include "script/test_stack.hpp"

namespace darkroom::fuzz::console_fuzz {
namespace {

std::string wrong_values(const Composer& composer) {
    for (std::size_t i = 0; i < composer.size(); ++i) {
        const Handle entry = composer.entry(i);
        for (const ParamInfo& row : composer.info(entry)->parameters.rows) {
            if (row.kind != Kind::Float && row.kind != Kind::Vec2 && row.kind != Kind::Rgb) continue;
            for (const std::uint32_t word : composer.words(entry).subspan(row.word, row.words)) {
                const auto value = std::bit_cast<float>(word);
                if (!(value >= static_cast<float>(row.range.min) && value <= static_cast<float>(row.range.max)))
                    return fmt::format("{}.{} is {}", composer.desc(entry)->name, row.name, value);
            }
        }
    }
    return {};
}

std::string run(std::string_view input) {
    test::ConsoleBed bed;
    bed.console->execute(input, {.max_commands = 200});
    const MemoryFile file(input);
    if (const Result<> done = bed.console->read_config(file.path()); !done)
        if (std::string wrong = wrong_error(done.error()); !wrong.empty()) return wrong;
    for (const std::string& line : bed.printed)
        if (std::string wrong = line.empty() ? std::string() : wrong_line(line); !wrong.empty()) return wrong;
    if (std::string wrong = wrong_values(bed.composer); !wrong.empty()) return wrong;
    for (const std::string& name : bed.console->names()) {
        const std::optional<std::string> text = bed.console->get(name);
        if (!text) return name + " is listed, and not there";
        bed.console->lock(name, false);
        const Result<std::string> set = bed.console->set(name, *text);
        // Of a table the name is shown, which only its host knows.
        if (!set && name != "sample.table") return fmt::format("{} is not set to its own {}", name, *text);
        if (bed.console->get(name) != text)
            return fmt::format("{} is {}, and {} when set to that", name, *text, *bed.console->get(name));
    }
    return {};
}

std::vector<std::string> seeds() {
    return {
        "warp.strength 0.5; cvarlist r_ui; echo hello",
        "set echo.scale 2\nseta contrast 1.5 // why\nreset contrast\ntoggle "
        "sample.is_on\n",
        "sample.shape star; sample.color 1 0.5 0; sample.offset \"-1, 1\"; "
        "sample.count 7; sample.curve 0:0,1:1",
        "alias a \"warp.strength 0; a\"; a; exec other.cfg; help; find strength; "
        "cvar_restart",
        "inc warp.strength 0.1; cycle sample.shape round square; bind x; unlock "
        "warp.strength; r_ui_warp 9e99",
    };
}

const Registration console({.name = "console", .run = run, .seeds = seeds, .longest = 2048});

}  // namespace
}  // namespace darkroom::fuzz::console_fuzz
