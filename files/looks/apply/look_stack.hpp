// SPDX-License-Identifier: MIT
#pragma once
// The stack that a look stands for, before a Composer has it: which entries have a place, in which order, and what each
// of their wires names.

#include <array>

#include "looks/look_parts.hpp"

namespace darkroom {

struct PlacedEntry {
    const LookEntry* entry = nullptr;
    std::string name;
    EntryDesc desc;  ///< but for what the wires name
    /// One of `wires`: an output of the look, or a picture of a file; of neither, it is the default.
    struct Wire {
        std::string_view output;
        bool is_previous = false;
        const LookResource* picture = nullptr;
    };
    std::array<Wire, wires.size()> ends{};
    bool has_values = true;  ///< false: the effect's defaults
};

/// In the order of the stack. Errors name the look and the entry: a wire to what no entry makes, a file that is not
/// loaded.
[[nodiscard]] Result<std::vector<PlacedEntry>> stack_of(const Look& look, const ApplyOptions& options);
/// For each entry of a look that of another look which is the same one (by LookEntry::id, else by its name), of the
/// same effect; null: there is none.
[[nodiscard]] std::vector<const LookEntry*> counterparts(const Look& of, const Look& in);

}  // namespace darkroom
