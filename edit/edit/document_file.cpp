// SPDX-License-Identifier: MIT
// A document and its file: reading, saving, and reading again what others have changed.
#include <fmt/format.h>

#include <algorithm>

#include "core/files.hpp"
#include "core/text/param_text.hpp"
#include "edit/document.hpp"
#include "edit/follow/compare.hpp"
#include "edit/splice/splice.hpp"
#include "looks/apply/look_resources.hpp"
#include "looks/apply/look_stack.hpp"

namespace darkroom::edit {

namespace {

/// Of tables and pictures the look of a text needs no more than that they are there.
Result<ResourceData> stand_in(const std::filesystem::path&, FileUse use) {
    if (use == FileUse::Table) return ResourceData(ColorTable{});
    return ResourceData(ResourceImage{1, 1, {0, 0, 0, 0}});
}

bool names_files(const Look& look) {
    const auto has_file = [](const LookEntry& entry) { return !entry.effect_file.empty() || !entry.resources.empty(); };
    const auto is_file = [](const LookLayer& layer) { return !layer.file.empty(); };
    return std::ranges::any_of(look.entries, has_file) || std::ranges::any_of(look.layers, is_file) ||
           (look.ui && (!look.ui->document.empty() || !look.ui->controllers.empty()));
}

/// What was read again and is as it was stays the one that it was, so that nothing is uploaded or compiled for it.
void keep_loaded(Look& look, const Look& before) {
    for (LookEntry& entry : look.entries)
        for (const LookEntry& other : before.entries) {
            if (entry.effect_owner && entry.effect_file == other.effect_file && is_same(*entry.effect, *other.effect)) {
                entry.effect = other.effect;
                entry.effect_owner = other.effect_owner;
            }
            for (LookResource& resource : entry.resources)
                for (const LookResource& old : other.resources)
                    if (resource.file == old.file && resource.data && old.data && is_same(*resource.data, *old.data))
                        resource.data = old.data;
        }
}

/// The values that both effects have, of a custom effect whose text changed.
std::vector<std::uint32_t> carried_over(const LookEntry& from, const EffectInfo& to) {
    std::vector<std::uint32_t> words(to.parameters.defaults.begin(), to.parameters.defaults.end());
    for (const ParamInfo& row : to.parameters.rows) {
        const ParamInfo* const old = from.effect->parameters.find(row.name);
        if (old == nullptr || old->kind != row.kind) continue;
        const auto value = std::span(from.words).subspan(old->word, old->words);
        if (check_words(row, value)) std::ranges::copy(value, words.begin() + row.word);
    }
    return words;
}

/// Loads anew what the entries of a look name.
Result<> load_again(Look& look, const LookOptions& options) {
    ResourceFiles files(options.folder, options);
    std::map<std::string, LookEntry> effects;
    for (LookEntry& entry : look.entries) {
        if (!entry.effect_file.empty()) {
            auto found = effects.find(entry.effect_file);
            if (found == effects.end()) {
                DARKROOM_TRY_VALUE(LookEntry made, custom_entry(options.folder / entry.effect_file));
                found = effects.emplace(entry.effect_file, std::move(made)).first;
            }
            entry.words = carried_over(entry, *found->second.effect);
            entry.effect = found->second.effect;
            entry.effect_owner = found->second.effect_owner;
        }
        for (const LookResource& resource : std::vector<LookResource>(entry.resources)) {
            const ParamInfo* const row = entry.effect->parameters.find(resource.parameter);
            const auto* const wire = std::ranges::find(wires, resource.parameter, &WireInfo::key);
            Result<> done;
            if (row != nullptr)
                done = files.put(entry, *row, resource.file);
            else if (wire != wires.end())
                done = files.put(entry, *wire, resource.file);
            if (!done) return done;
        }
    }
    return {};
}

}  // namespace

Result<LookDocument> LookDocument::open(const std::filesystem::path& file, LookOptions options,
                                        const CameraLens& lens) {
    const auto read = Watch::Clock::now();
    if (options.folder.empty()) options.folder = file.parent_path();
    DARKROOM_TRY_VALUE(std::string text, read_look_text(file));
    std::vector<std::string> warnings;
    std::vector<std::string>* const told = std::exchange(options.warnings, &warnings);
    Result<Look> look = parse_look(text, file.string(), options, lens);
    if (told != nullptr) told->insert(told->end(), warnings.begin(), warnings.end());
    if (!look) return failure(std::move(look));
    LookDocument out(std::move(*look), std::move(options));
    out.file_ = file;
    out.lens_ = lens;
    out.text_ = out.read_text_ = std::move(text);
    out.warnings_ = std::move(warnings);
    out.watch_ = {};
    out.watch_files(read);
    return out;
}

void LookDocument::watch_files(Watch::Clock::time_point read) {
    if (!file_.empty()) watch_.add(file_, read);
    const auto add = [&](const std::string& name) {
        if (!name.empty()) watch_.add(options_.folder / name, read);
    };
    for (const LookEntry& entry : look_.entries) {
        add(entry.effect_file);
        for (const LookResource& resource : entry.resources) add(resource.file);
    }
    for (const LookLayer& layer : look_.layers) add(layer.file);
}

Result<> LookDocument::save() {
    if (file_.empty()) return user_error("the look has no file yet: it needs a name to be saved");
    std::error_code error;
    // Where it is gone there is nothing of others to lose.
    if (!std::filesystem::exists(file_, error) && !error) return write(file_, true);
    DARKROOM_TRY_VALUE(const std::string now, read_look_text(file_));
    if (now != text_)
        return user_error(fmt::format("{}: it has been changed by others since it was read; it is not overwritten",
                                      printable(file_.string())));
    return write(file_, true);
}

Result<> LookDocument::save_as(const std::filesystem::path& file) {
    const bool is_near =
        !file_.empty() && file.parent_path().lexically_normal() == file_.parent_path().lexically_normal();
    if (is_near) return write(file, true);
    if (names_files(look_) && file.parent_path().lexically_normal() != options_.folder.lexically_normal())
        return user_error(fmt::format("{}: the look names files relative to {}: save it in that folder",
                                      printable(file.string()), printable(options_.folder.string())));
    return write(file, false);
}

Result<> LookDocument::write(const std::filesystem::path& file, bool is_spliced) {
    LookOptions options = options_;
    options.folder = file.parent_path();
    options.is_scene &= is_spliced;
    const std::string shown = file.string();
    LookOptions checking = options;
    checking.load_resource = stand_in;
    const auto checked = [&](Result<std::string> text) -> Result<std::string> {
        if (!text) return text;
        const Result<Look> read = parse_look(*text, shown, checking, lens_);
        // A look is saved even if its custom effect has an error at the moment.
        const bool is_readable = read || (is_spliced && parse_look(text_, shown, checking));
        if (is_readable && !read) return failure(read.error());
        if (is_readable && !reads_as(*read, look_))
            return user_error(
                fmt::format("{}: the look cannot be written so that it reads as the same", printable(shown)));
        return text;
    };
    Result<std::string> text = checked(is_spliced ? splice_look(read_text_, read_, look_, lens_) : new_text());
    if (!text && is_spliced) text = checked(splice_look(text_, saved_, look_, lens_));
    if (!text) return failure(text.error());
    DARKROOM_TRY(write_file(file, std::as_bytes(std::span(*text)), true));
    file_ = file;
    text_ = *text;
    options_ = std::move(options);
    saved_ = look_;
    if (!is_spliced) {
        read_text_ = text_;
        read_ = look_;
    }
    is_changed_ = false;
    watch_.take(file);
    end_merge();
    return {};
}

std::string LookDocument::new_text() const {
    constexpr std::string_view nothing = "format = 1\n\n[post_process]\n";
    LookOptions options = options_;
    options.load_resource = stand_in;
    options.is_scene = false;
    if (const Result<Look> base = parse_look(nothing, "", options, lens_))
        if (Result<std::string> text = splice_look(nothing, *base, look_, lens_))
            if (const Result<Look> again = parse_look(*text, "", options, lens_); again && reads_as(*again, look_))
                return std::move(*text);
    return write_look(look_);
}

Result<std::string> LookDocument::unsaved_text() const {
    if (file_.empty()) return new_text();
    Result<std::string> text = splice_look(read_text_, read_, look_, lens_);
    return text ? text : splice_look(text_, saved_, look_, lens_);
}

Result<> LookDocument::take_unsaved(std::string_view text) {
    DARKROOM_TRY_VALUE(Look now, read(text, look_));
    return edit("unsaved edits", [&](Look& look) -> Result<> {
        look = now;
        return {};
    });
}

Result<bool> LookDocument::reload_if_changed() {
    std::vector<std::filesystem::path> changed = watch_.take_changes();
    if (changed.empty()) return false;
    changed_files_ = std::move(changed);
    Result<bool> is_new = reload();
    is_broken_ = !is_new;
    return is_new;
}

/// Entries are those of `ids_of` that they are the counterparts of.
Result<Look> LookDocument::read(std::string_view text, const Look& ids_of) {
    DARKROOM_TRY_VALUE(Look read, parse_look(text, file_.string(), options_, lens_));
    const std::vector<const LookEntry*> others = counterparts(read, ids_of);
    for (std::size_t i = 0; i < others.size(); ++i) read.entries[i].id = others[i] == nullptr ? 0 : others[i]->id;
    give_ids(read);
    return read;
}

// One that the present look does not name may have changed unseen.
void LookDocument::keep_effects(Look& look, const Look& now) const {
    for (LookEntry& entry : look.entries) {
        if (entry.effect_file.empty()) continue;
        const auto found = std::ranges::find(now.entries, entry.effect_file, &LookEntry::effect_file);
        LookEntry read{};
        if (found == now.entries.end())
            if (Result<LookEntry> made = custom_entry(options_.folder / entry.effect_file)) read = std::move(*made);
        const LookEntry& newest = found == now.entries.end() ? read : *found;
        if (newest.effect == nullptr || is_same(*newest.effect, *entry.effect)) continue;
        entry.words = carried_over(entry, *newest.effect);
        entry.effect = newest.effect;
        entry.effect_owner = newest.effect_owner;
    }
}

Result<bool> LookDocument::reload() {
    const auto began = Watch::Clock::now();
    std::string text;
    if (!file_.empty()) {
        DARKROOM_TRY_VALUE(std::string now, read_look_text(file_));
        // An editor that is about to write it: the watch will tell.
        if (now.empty() && !text_.empty()) return false;
        text = std::move(now);
    }
    warnings_.clear();
    Look saved = saved_, next = look_;
    if (!file_.empty()) {
        options_.warnings = &warnings_;
        Result<Look> now = read(text, look_);
        options_.warnings = nullptr;
        if (!now) return failure(std::move(now));
        saved = std::move(*now);
        keep_loaded(saved, look_);
    }
    if (!file_.empty() && (text != text_ || !is_changed_)) {
        next = saved;
    } else {
        DARKROOM_TRY(load_again(next, options_));
        for (LookLayer& layer : next.layers) {
            const auto read = std::ranges::find(saved.layers, layer.name, &LookLayer::name);
            if (!layer.file.empty() && read != saved.layers.end()) layer.values = read->values;
        }
        keep_loaded(next, look_);
    }
    // An effect of a file that the text names may have other parameters now: its look is read again, too.
    Result<Look> base = text == text_ && !file_.empty() ? read(read_text_, read_) : Result<Look>(saved);
    if (text != text_ || !base) read_text_ = text;
    read_ = base ? std::move(*base) : saved;
    saved_ = std::move(saved);
    text_ = std::move(text);
    watch_files(began);
    if (is_same(next, look_)) {
        is_changed_ = !says_same(look_, saved_);
        return false;
    }
    keep_effects(look_, next);
    if (!is_same(next, look_)) {
        remember("Reload");
        redo_.clear();
    }
    end_merge();
    take(std::move(next));
    return true;
}

}  // namespace darkroom::edit
