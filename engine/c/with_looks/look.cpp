// SPDX-License-Identifier: MIT
#include <darkroom/look.hpp>

#include "c/call.hpp"
#include "c/objects.hpp"
#include "c/resource_of.hpp"
#include "core/text/param_text.hpp"

struct DarkroomLookObject {
    darkroom::Look look;
    std::string text{};
    std::vector<std::string> names{};
};

namespace darkroom::c {

namespace {

/// The host's reader of files as one of C++.
ResourceLoader loader_of(DarkroomLoadResource load, void* user) {
    if (load == nullptr) return {};
    return [load, user](const std::filesystem::path& path, FileUse use) -> Result<ResourceData> {
        DarkroomTable table{};
        table.struct_size = sizeof table;
        DarkroomPicture picture{};
        picture.struct_size = sizeof picture;
        const DarkroomResult result =
            load(user, path.string().c_str(), static_cast<DarkroomFileUse>(use), &table, &picture);
        if (result != DARKROOM_OK)
            return user_error(fmt::format("{}: load_resource returned {}", path.string(), static_cast<int>(result)));
        if (use == FileUse::Table) return ResourceData(table_of(table));
        return ResourceData(picture_of(picture));
    };
}

/// Runs `work` with the options, then hands the warnings over.
template <class Work>
Result<> with_options(const DarkroomLookOptions* given, const Work& work) {
    DARKROOM_TRY_VALUE(const auto options, read_or_default(given, "DarkroomLookOptions"));
    std::vector<std::string> warnings;
    LookOptions out{.is_strict = options.is_strict != 0,
                    .warnings = &warnings,
                    .allows_custom_effects = options.allows_custom_effects != 0,
                    .allows_modulation = options.no_modulation == 0,
                    .load_resource = loader_of(options.load_resource, options.user),
                    .reads_tables = options.no_tables == 0,
                    .folder = string(options.folder)};
    Result<> done = work(out);
    if (options.warn != nullptr)
        for (const std::string& warning : warnings) options.warn(options.user, warning.c_str());
    return done;
}

Result<> give(Result<Look> look, DarkroomLook* out) {
    if (!look) return failure(std::move(look));
    *out = new DarkroomLookObject{std::move(*look)};
    return {};
}

struct Keeps {
    std::vector<std::string> names;
    ApplyOptions options;
};
Result<> read_options(const DarkroomApplyOptions* given, Keeps& out) {
    DARKROOM_TRY_VALUE(const auto options, read_or_default(given, "DarkroomApplyOptions"));
    if (options.keep_count > max_elements)
        return user_error(fmt::format("keep_count = {}: allowed is at most {}", options.keep_count, max_elements));
    for (std::uint32_t i = 0; i < options.keep_count; ++i) {
        DARKROOM_TRY(needs("keeps", options.keeps, "a name of keeps", options.keeps ? options.keeps[i] : ""));
        out.names.emplace_back(options.keeps[i]);
    }
    out.options = {.keeps_what_is_off = options.keeps_what_is_off != 0, .keeps = out.names};
    return {};
}

}  // namespace

}  // namespace darkroom::c

using namespace darkroom;
using namespace darkroom::c;

DarkroomResult darkroom_look_default(DarkroomLookOrder order, DarkroomLook* look) {
    return call("darkroom_look_default", [&]() -> Result<> {
        DARKROOM_TRY(needs("look", look));
        DARKROOM_TRY_VALUE(const auto kind, enumerator<LookOrder>(order, DARKROOM_LOOK_ORDER_SCENE_LINEAR, "order"));
        return give(default_look(kind), look);
    });
}

DarkroomResult darkroom_look_default_of_traced_light(DarkroomLook* look) {
    return call("darkroom_look_default_of_traced_light", [&]() -> Result<> {
        DARKROOM_TRY(needs("look", look));
        return give(default_look_of_traced_light(), look);
    });
}

DarkroomResult darkroom_look_parse(const char* text, const char* shown_name, const DarkroomLookOptions* options,
                                   DarkroomLook* look) {
    return call("darkroom_look_parse", [&]() -> Result<> {
        DARKROOM_TRY(needs("text", text, "shown_name", shown_name, "look", look));
        return with_options(options,
                            [&](const LookOptions& use) { return give(parse_look(text, shown_name, use), look); });
    });
}

DarkroomResult darkroom_look_read(const char* path, const DarkroomLookOptions* options, DarkroomLook* look) {
    return call("darkroom_look_read", [&]() -> Result<> {
        DARKROOM_TRY(needs("path", path, "look", look));
        return with_options(options, [&](const LookOptions& use) { return give(read_look(path, use), look); });
    });
}

void darkroom_look_destroy(DarkroomLook look) { delete look; }

const char* darkroom_look_write(DarkroomLook look) {
    return call_for<const char*>("darkroom_look_write", nullptr, [&]() -> const char* {
        if (look == nullptr) return nullptr;
        look->text = write_look(look->look);
        return look->text.c_str();
    });
}

DarkroomResult darkroom_look_set_order(DarkroomLook look, DarkroomLookOrder order) {
    return call("darkroom_look_set_order", [&]() -> Result<> {
        DARKROOM_TRY(needs("look", look));
        DARKROOM_TRY_VALUE(const auto kind, enumerator<LookOrder>(order, DARKROOM_LOOK_ORDER_SCENE_LINEAR, "order"));
        set_order(look->look, kind);
        return {};
    });
}

DarkroomResult darkroom_look_switch_off(DarkroomLook look) {
    return call("darkroom_look_switch_off", [&]() -> Result<> {
        DARKROOM_TRY(needs("look", look));
        look->look = switched_off(look->look);
        return {};
    });
}

DarkroomResult darkroom_look_exposure(DarkroomLook look, float* exposure) {
    return call("darkroom_look_exposure", [&]() -> Result<> {
        DARKROOM_TRY(needs("look", look, "exposure", exposure));
        *exposure = exposure_of(look->look);
        return {};
    });
}

DarkroomResult darkroom_look_add_ui(DarkroomLook look) {
    return call("darkroom_look_add_ui", [&]() -> Result<> {
        DARKROOM_TRY(needs("look", look));
        add_ui(look->look);
        return {};
    });
}

DarkroomResult darkroom_look_lay_over(DarkroomLook look, const char* file, const DarkroomLookOptions* options) {
    return call("darkroom_look_lay_over", [&]() -> Result<> {
        DARKROOM_TRY(needs("look", look, "file", file));
        return with_options(options, [&](const LookOptions& use) { return lay_over(look->look, file, use); });
    });
}

DarkroomResult darkroom_look_override(DarkroomLook look, const char* key, const char* value) {
    return call("darkroom_look_override", [&]() -> Result<> {
        DARKROOM_TRY(needs("look", look, "key", key, "value", value));
        const LookOverride one{.key = key, .text = value, .shown = key};
        return override_look(look->look, std::span(&one, 1));
    });
}

DarkroomResult darkroom_look_place(DarkroomLook look, const char* effect) {
    return call("darkroom_look_place", [&]() -> Result<> {
        DARKROOM_TRY(needs("look", look, "effect", effect));
        DARKROOM_TRY_VALUE(const auto info, effect_named(effect));
        return place_entry(look->look, flat_entry(*info, LookOrder::SceneLinear));
    });
}

DarkroomResult darkroom_look_place_custom(DarkroomLook look, const char* file) {
    return call("darkroom_look_place_custom", [&]() -> Result<> {
        DARKROOM_TRY(needs("look", look, "file", file));
        DARKROOM_TRY_VALUE(auto entry, custom_entry(file));
        return place_entry(look->look, std::move(entry));
    });
}

const char* darkroom_look_entry_name(DarkroomLook look, uint32_t index) {
    return call_for<const char*>("darkroom_look_entry_name", nullptr, [&]() -> const char* {
        if (look == nullptr) return nullptr;
        look->names = entry_names(look->look);
        return index < look->names.size() ? look->names[index].c_str() : nullptr;
    });
}

DarkroomResult darkroom_look_apply(DarkroomLook look, DarkroomComposer composer, const DarkroomApplyOptions* given) {
    return call("darkroom_look_apply", [&]() -> Result<> {
        DARKROOM_TRY(needs("look", look, "composer", composer));
        Keeps keeps;
        DARKROOM_TRY(read_options(given, keeps));
        return apply(look->look, composer->composer, keeps.options);
    });
}

DarkroomResult darkroom_look_follow(DarkroomLook was, DarkroomLook is, DarkroomComposer composer,
                                    const DarkroomApplyOptions* given, VkBool32* needs_compile) {
    return call("darkroom_look_follow", [&]() -> Result<> {
        DARKROOM_TRY(needs("was", was, "is", is, "composer", composer));
        Keeps keeps;
        DARKROOM_TRY(read_options(given, keeps));
        DARKROOM_TRY_VALUE(const auto followed, follow(was->look, is->look, composer->composer, keeps.options));
        if (needs_compile != nullptr) *needs_compile = followed.needs_compile;
        return {};
    });
}
