// SPDX-License-Identifier: MIT
// A document and the camera that its look is for.
#include <algorithm>

#include "edit/document.hpp"
#include "edit/follow/compare.hpp"
#include "looks/look_parts.hpp"

namespace darkroom::edit {

namespace {

/// Rows of a lens that are as in `was` become those of `is`, which has the same entries.
void carry_lens(Look& look, const Look& was, const Look& is) {
    for (LookEntry& entry : look.entries) {
        const auto old = std::ranges::find(was.entries, entry.id, &LookEntry::id);
        if (old == was.entries.end() || old->effect->name != entry.effect->name) continue;
        const LookEntry& now = is.entries[static_cast<std::size_t>(old - was.entries.begin())];
        for (const LensKey& key : lens_keys) {
            const ParamInfo* const row = entry.effect->parameters.find(key.row);
            const ParamInfo* const row_now = now.effect->parameters.find(key.row);
            if (row != nullptr && row_now != nullptr && has_same(entry, *old, *row))
                entry.words[row->word] = now.words[row_now->word];
        }
    }
}

}  // namespace

void LookDocument::follow_lens(const CameraLens& lens) {
    if (file_.empty() || lens == lens_) return;
    LookOptions options = options_;
    options.warnings = nullptr;
    const Result<Look> saved = parse_look(text_, file_.string(), options, lens);
    const Result<Look> base = parse_look(read_text_, file_.string(), options, lens);
    // A file that it names is missing at the moment.
    if (!saved || !base) return;
    lens_ = lens;
    for (std::deque<Step>* const steps : {&undo_, &redo_})
        for (Step& step : *steps) carry_lens(step.look, saved_, *saved);
    Look next = look_;
    carry_lens(next, saved_, *saved);
    carry_lens(read_, Look(read_), *base);
    carry_lens(saved_, Look(saved_), *saved);
    take(std::move(next));
}

}  // namespace darkroom::edit
