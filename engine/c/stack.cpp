// SPDX-License-Identifier: MIT
// The composer's stack: entries, their wires, tables and pictures.
#include "c/frame_of.hpp"
#include "c/resource_of.hpp"

namespace darkroom::c {

namespace {

/// What `desc` of an entry says of its effect's values: null: nothing.
Result<const std::uint32_t*> words_of(const DarkroomEntryDesc& desc, const EffectInfo& effect) {
    if (desc.words != nullptr && desc.word_count != effect.parameters.words())
        return user_error(
            fmt::format("word_count = {}: {} has {} words", desc.word_count, effect.name, effect.parameters.words()));
    return desc.words;
}

/// Adds an effect, at the end or, of a given `before`, in front of that entry.
Result<> add(DarkroomComposer composer, const EffectInfo& effect, Handle before, const DarkroomEntryDesc* given,
             DarkroomHandle* handle) {
    DARKROOM_TRY_VALUE(const auto desc, read_or_default(given, "DarkroomEntryDesc"));
    DARKROOM_TRY_VALUE(const auto entry, entry_desc_of(desc));
    DARKROOM_TRY_VALUE(const auto words, words_of(desc, effect));
    Handle made;
    if (before.is_given()) {
        DARKROOM_TRY_VALUE(made, composer->composer.insert(before, effect, words, entry));
    } else {
        made = composer->composer.add(effect, words, entry);
        if (!made.is_given()) return machine_error("out of memory", ErrorCode::OutOfMemory);
    }
    if (handle != nullptr) *handle = number_of(made);
    return {};
}

}  // namespace

}  // namespace darkroom::c

using namespace darkroom;
using namespace darkroom::c;

DarkroomResult darkroom_composer_create(DarkroomDevice device, const DarkroomComposerDesc* given,
                                        DarkroomComposer* composer) {
    return call("darkroom_composer_create", [&]() -> Result<> {
        DARKROOM_TRY(needs("device", device, "composer", composer));
        DARKROOM_TRY_VALUE(const auto desc, read_or_default(given, "DarkroomComposerDesc"));
        ComposerDesc out;
        if (desc.frames_in_flight != 0) out.frames_in_flight = desc.frames_in_flight;
        out.has_timers = desc.has_timers != 0;
        if (desc.max_threads != 0) out.max_threads = desc.max_threads;
        if (desc.no_threads != 0) out.max_threads = 0;
        *composer = new DarkroomComposerObject{Composer(device->device, out)};
        return {};
    });
}

void darkroom_composer_destroy(DarkroomComposer composer) { delete composer; }

DarkroomResult darkroom_composer_add(DarkroomComposer composer, const char* effect, const DarkroomEntryDesc* desc,
                                     DarkroomHandle* handle) {
    return call("darkroom_composer_add", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "effect", effect));
        DARKROOM_TRY_VALUE(const auto info, effect_named(effect));
        return add(composer, *info, {}, desc, handle);
    });
}

DarkroomResult darkroom_composer_add_effect(DarkroomComposer composer, DarkroomEffect effect,
                                            const DarkroomEntryDesc* desc, DarkroomHandle* handle) {
    return call("darkroom_composer_add_effect", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "effect", effect));
        return add(composer, *effect->info, {}, desc, handle);
    });
}

DarkroomResult darkroom_composer_insert(DarkroomComposer composer, DarkroomHandle before, DarkroomEffect effect,
                                        const DarkroomEntryDesc* desc, DarkroomHandle* handle) {
    return call("darkroom_composer_insert", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "effect", effect));
        DARKROOM_TRY(composer->composer.check(handle_of(before)));
        return add(composer, *effect->info, handle_of(before), desc, handle);
    });
}

DarkroomResult darkroom_composer_remove(DarkroomComposer composer, DarkroomHandle handle) {
    return call("darkroom_composer_remove", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer));
        return composer->composer.remove(handle_of(handle));
    });
}

DarkroomResult darkroom_composer_move(DarkroomComposer composer, DarkroomHandle handle, DarkroomHandle before) {
    return call("darkroom_composer_move", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer));
        return composer->composer.move(handle_of(handle), handle_of(before));
    });
}

DarkroomResult darkroom_composer_replace(DarkroomComposer composer, DarkroomHandle handle, DarkroomEffect effect) {
    return call("darkroom_composer_replace", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "effect", effect));
        return composer->composer.replace(handle_of(handle), *effect->info, nullptr);
    });
}

DarkroomResult darkroom_composer_rewire(DarkroomComposer composer, DarkroomHandle handle,
                                        const DarkroomEntryDesc* given) {
    return call("darkroom_composer_rewire", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "desc", given));
        DARKROOM_TRY_VALUE(const auto desc, read(given, "DarkroomEntryDesc"));
        DARKROOM_TRY_VALUE(const auto entry, entry_desc_of(desc));
        return composer->composer.rewire(handle_of(handle), entry);
    });
}

DarkroomResult darkroom_composer_clear(DarkroomComposer composer) {
    return call("darkroom_composer_clear", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer));
        composer->composer.clear();
        return {};
    });
}

DarkroomResult darkroom_composer_define_table(DarkroomComposer composer, const DarkroomTable* given,
                                              uint32_t* resource) {
    return call("darkroom_composer_define_table", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "table", given, "resource", resource));
        DARKROOM_TRY_VALUE(const auto table, read(given, "DarkroomTable"));
        DARKROOM_TRY_VALUE(const auto defined, composer->composer.define(table_of(table)));
        *resource = defined.id;
        return {};
    });
}

DarkroomResult darkroom_composer_define_picture(DarkroomComposer composer, const DarkroomPicture* given,
                                                uint32_t* resource) {
    return call("darkroom_composer_define_picture", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "picture", given, "resource", resource));
        DARKROOM_TRY_VALUE(const auto picture, read(given, "DarkroomPicture"));
        DARKROOM_TRY_VALUE(const auto defined, composer->composer.define(picture_of(picture)));
        *resource = defined.id;
        return {};
    });
}

DarkroomResult darkroom_composer_forget(DarkroomComposer composer, uint32_t resource) {
    return call("darkroom_composer_forget", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer));
        composer->composer.forget({resource});
        return {};
    });
}

DarkroomResult darkroom_composer_resources(DarkroomComposer composer, uint32_t* resources, uint32_t* count) {
    return call("darkroom_composer_resources", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "count", count));
        std::vector<std::uint32_t> ids;
        for (const auto& [id, data] : composer->composer.resources()) ids.push_back(id);
        write_all<std::uint32_t>(ids, resources, count);
        return {};
    });
}

DarkroomHandle darkroom_composer_picture_of(uint32_t resource) { return number_of(Composer::picture_of({resource})); }
DarkroomHandle darkroom_handle_previous(DarkroomHandle handle) { return number_of(handle_of(handle).previous()); }

DarkroomResult darkroom_composer_find(DarkroomComposer composer, const char* name, DarkroomHandle* handle) {
    return call("darkroom_composer_find", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "name", name, "handle", handle));
        const auto found = composer->composer.find(name);
        if (!found) return user_error(fmt::format("entry '{}': there is none of that name", name));
        *handle = number_of(*found);
        return {};
    });
}

DarkroomResult darkroom_composer_size(DarkroomComposer composer, uint32_t* count) {
    return call("darkroom_composer_size", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "count", count));
        *count = static_cast<std::uint32_t>(composer->composer.size());
        return {};
    });
}

DarkroomResult darkroom_composer_entry(DarkroomComposer composer, uint32_t index, DarkroomHandle* handle) {
    return call("darkroom_composer_entry", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "handle", handle));
        if (index >= composer->composer.size())
            return user_error(fmt::format("index = {}: the stack has {} entries", index, composer->composer.size()));
        *handle = number_of(composer->composer.entry(index));
        return {};
    });
}

DarkroomResult darkroom_composer_check(DarkroomComposer composer, DarkroomHandle handle) {
    return call("darkroom_composer_check", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer));
        return composer->composer.check(handle_of(handle));
    });
}

DarkroomResult darkroom_composer_info(DarkroomComposer composer, DarkroomHandle handle, DarkroomEffect* effect) {
    return call("darkroom_composer_info", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "effect", effect));
        DARKROOM_TRY(composer->composer.check(handle_of(handle)));
        const EffectInfo& info = *composer->composer.info(handle_of(handle));
        const auto is_used = [&](const EffectInfo* custom) {
            for (std::size_t i = 0; i < composer->composer.size(); ++i)
                if (composer->composer.info(composer->composer.entry(i)) == custom) return true;
            return false;
        };
        std::erase_if(composer->custom_effects, [&](const auto& kept) { return !is_used(kept.first); });
        DarkroomEffect found = effect_of(info);
        if (found == nullptr) {
            auto& own = composer->custom_effects[&info];
            if (own == nullptr) own = std::make_unique<DarkroomEffectObject>(info);
            found = own.get();
        }
        *effect = found;
        return {};
    });
}

DarkroomResult darkroom_composer_desc(DarkroomComposer composer, DarkroomHandle handle, DarkroomEntryDesc* desc) {
    return call("darkroom_composer_desc", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "desc", desc));
        DARKROOM_TRY(composer->composer.check(handle_of(handle)));
        const EntryDesc& entry = *composer->composer.desc(handle_of(handle));
        const auto words = composer->composer.words(handle_of(handle));
        DarkroomEntryDesc out{};
        out.blend = static_cast<DarkroomBlendMode>(entry.blend);
        out.input = number_of(entry.input);
        out.source = number_of(entry.source);
        out.second = number_of(entry.second);
        out.mask = number_of(entry.mask);
        out.name = entry.name.c_str();
        out.output = entry.output.c_str();
        out.opacity = entry.opacity;
        out.has_opacity = VK_TRUE;
        out.is_ui = entry.is_ui;
        out.is_disabled = !entry.enabled;
        out.scale_numerator = entry.scale.numerator;
        out.scale_denominator = entry.scale.denominator;
        out.format = entry.format;
        out.words = words.data();
        out.word_count = static_cast<std::uint32_t>(words.size());
        return write(desc, out, "DarkroomEntryDesc");
    });
}

DarkroomResult darkroom_composer_words(DarkroomComposer composer, DarkroomHandle handle, uint32_t* words,
                                       uint32_t* count) {
    return call("darkroom_composer_words", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "count", count));
        DARKROOM_TRY(composer->composer.check(handle_of(handle)));
        write_all(composer->composer.words(handle_of(handle)), words, count);
        return {};
    });
}
