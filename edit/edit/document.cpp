// SPDX-License-Identifier: MIT
#include "edit/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "core/text/param_text.hpp"
#include "edit/follow/compare.hpp"
#include "looks/apply/look_stack.hpp"
#include "looks/look_parts.hpp"

namespace darkroom::edit {

namespace {

/// Of those tables and pictures of a look that another look has not.
std::size_t bytes_of_rest(const Look& look, const Look& but) {
    std::set<const ResourceData*> seen;
    for (const LookEntry& entry : but.entries)
        for (const LookResource& resource : entry.resources) seen.insert(resource.data.get());
    std::size_t bytes = 0;
    for (const LookEntry& entry : look.entries)
        for (const LookResource& resource : entry.resources)
            if (resource.data != nullptr && seen.insert(resource.data.get()).second) bytes += bytes_of(*resource.data);
    return bytes;
}

}  // namespace

LookDocument::LookDocument(Look look, LookOptions options) : options_(std::move(options)) {
    options_.warnings = nullptr;
    give_ids(look);
    saved_ = read_ = look;
    take(std::move(look));
}

Result<> LookDocument::edit(std::string what, const std::function<Result<>(Look&)>& change, std::string_view merge) {
    Look next = look_;
    DARKROOM_TRY(change(next));
    if (is_same(next, look_)) return {};
    DARKROOM_TRY(check(next));
    give_ids(next);
    if (merge.empty() || merge != merge_ || undo_.empty()) remember(std::move(what));
    redo_.clear();
    merge_ = merge;
    take(std::move(next));
    return {};
}

Result<> LookDocument::check(const Look& next) const {
    const std::vector<std::string> names = entry_names(next);
    const auto shown = [&](std::size_t entry) { return names[entry]; };
    if (const std::vector<LookProblem> problems = problems_of(next, shown); !problems.empty())
        return user_error(problems.front().text);
    // Pulses and layers know their entries by names. Those that went along with their entry hold nothing.
    const std::vector<std::string> names_before = entry_names(look_);
    for (std::size_t i = 0; i < names_before.size(); ++i) {
        if (!is_moved(look_, names_before[i]) || !is_moved(next, names_before[i])) continue;
        const auto now = std::ranges::find(names, names_before[i]) - names.begin();
        if (static_cast<std::size_t>(now) < names.size() &&
            next.entries[static_cast<std::size_t>(now)].id == look_.entries[i].id)
            continue;
        return user_error(
            fmt::format("{}: a pulse or a layer moves it, so it keeps its place and its name", names_before[i]));
    }
    return {};
}

void LookDocument::take(Look look) {
    look_ = std::move(look);
    is_changed_ = !says_same(look_, saved_);
    ++version_;
    watch_files();
}

void LookDocument::remember(std::string what) {
    undo_.push_back({std::move(what), look_, bytes_of(look_)});
    if (undo_.size() > 1) {
        Step& before = undo_[undo_.size() - 2];
        before.bytes += bytes_of_rest(before.look, look_);
    }
    std::size_t bytes = 0;
    for (const Step& step : undo_) bytes += step.bytes;
    for (; undo_.size() > 1 && (undo_.size() > max_steps || bytes > max_history_bytes); undo_.pop_front())
        bytes -= undo_.front().bytes;
}

void LookDocument::give_ids(Look& look) {
    std::set<std::uint64_t> seen;
    for (LookEntry& entry : look.entries) {
        if (entry.id == 0 || entry.id > last_id_ || seen.contains(entry.id)) entry.id = ++last_id_;
        seen.insert(entry.id);
    }
}

std::string_view LookDocument::undo_name() const { return undo_.empty() ? std::string_view() : undo_.back().what; }
std::string_view LookDocument::redo_name() const { return redo_.empty() ? std::string_view() : redo_.back().what; }

void LookDocument::undo() {
    if (undo_.empty()) return;
    Step step = std::move(undo_.back());
    undo_.pop_back();
    keep_effects(step.look, look_);
    redo_.push_back({std::move(step.what), look_});
    merge_.clear();
    take(std::move(step.look));
}

void LookDocument::redo() {
    if (redo_.empty()) return;
    Step step = std::move(redo_.back());
    redo_.pop_back();
    keep_effects(step.look, look_);
    remember(std::move(step.what));
    take(std::move(step.look));
}

void Watch::add(const std::filesystem::path& file, Clock::time_point read) {
    // Files have the time of the last tick.
    constexpr std::chrono::milliseconds tick{10};
    if (files_.contains(file)) return;
    const FileStamp stamp = stamp_of(file);
    const auto saved = std::chrono::seconds(stamp.seconds) + std::chrono::nanoseconds(stamp.nanoseconds);
    files_.emplace(file, saved > (read - tick).time_since_epoch() ? FileStamp{} : stamp);
}

std::vector<std::filesystem::path> Watch::take_changes() {
    std::vector<std::filesystem::path> changed;
    for (auto& [file, stamp] : files_) {
        const FileStamp now = stamp_of(file);
        if (now == stamp || now == FileStamp{}) continue;
        stamp = now;
        changed.push_back(file);
    }
    return changed;
}

// A document and the camera that its look is for.

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
