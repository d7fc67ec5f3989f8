// SPDX-License-Identifier: MIT
#pragma once
// A look is what an artist ships: an ordered stack of effects with their values, as a TOML file. It is either the flat
// table [post_process], whose order is fixed, or a list of [[stack]] entries in any order, with names to wire them. A
// Look is data: it holds no device, and `apply` fills a Composer with it.
//
//     [post_process]                 [[stack]]
//     bloom_intensity = 0.04         effect = "gaussian_blur"
//     exposure = 1.2                 radius = 4.0
//                                    output = "blurred"
//
// With either may stand a table [ui], for the interface and its own chain.
//
// Part of the optional target Darkroom::looks; the core library reads no files.

#include <cstdint>
#include <darkroom/composer.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/game_table.hpp>
#include <darkroom/param.hpp>
#include <darkroom/result.hpp>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace darkroom {

/// Formats that an entry's output may have as an image. Any: that of the pictures between kernels.
enum class EntryFormat : std::uint32_t { Any, Rgba8, Rgba16, Rgba16f, Rgba32f, Rgb10a2, R11g11b10f, R8, R16f, R32f };

/// What every stack entry has beside the effect's own parameters.
struct EntryState {
    Toggle enabled = true;
    float opacity = 1.0f;
    BlendMode blend = BlendMode::Mix;
    float scale = 1.0f;
    EntryFormat format = EntryFormat::Any;
};
/// The rows of that struct.
extern const ParamTable entry_rows;

/// A file that a parameter of kind Resource, or a wire, names: a colour table or a picture.
struct LookResource {
    std::string parameter;  ///< name of its row, or of the wire
    std::string file;       ///< as the look has it: relative to the look, or as typed
    std::shared_ptr<const ResourceData> data;
};

/// One effect of a look. The wires are names: "scene" is the picture as it came, "alpha" its alpha as a grey picture,
/// others are the `output` of an entry before this one; "NAME.previous" is the output of any entry, or the scene, one
/// frame before; a name with another dot is the file of a picture; empty is the default of darkroom::EntryDesc.
struct LookEntry {
    const EffectInfo* effect = nullptr;
    std::vector<std::uint32_t> words;  ///< of the effect's struct; a Resource is the number of one of these, from 1:
    std::vector<LookResource> resources{};
    EntryState state;
    std::string name;  ///< empty: see entry_names
    std::string input, source, second, mask, output;
    /// Of a flat table: what was written or typed switches it on, not the table by itself.
    bool is_asked_for = false;
    bool is_of_ui = false;                       ///< of the table [ui]: in a stack, behind all that is listed
    std::string effect_file{};                   ///< of a custom effect: its file, as the look names it
    std::shared_ptr<const void> effect_owner{};  ///< keeps a custom effect for as long as the entry
    /// Tells it from the others while a look is edited, however it is moved or renamed; 0: its name does.
    std::uint64_t id = 0;
};

/// What a pulse or a layer has beside its name and what it moves.
struct PulseState {
    Envelope envelope = Envelope::Linear;
    float duration = 0.3f;
};
struct LayerState {
    float weight = 0.0f;
};
/// The rows of these two, and of LayerDistance.
extern const ParamTable pulse_rows, layer_rows, distance_rows;

/// See PulseDesc.
struct LookPulse {
    std::string event;
    std::string entry, parameter;  ///< names
    std::array<float, 4> amount{};
    PulseState state;
};
/// See LayerDesc. Of a layer that is a look, the values are all those in which that look's entries differ, or may come
/// to differ, from this one's of the same names.
struct LookLayer {
    struct Value {
        std::string entry, parameter;  ///< names; or the entry's `enabled` or `opacity`
        std::vector<std::uint32_t> words;
    };
    std::string name;
    std::string file;  ///< of its look, relative to this one; empty: it is the values alone
    LayerState state;
    std::optional<LayerDistance> distance;
    std::vector<Value> values;
};

/// The two shipped orders of the flat table: that of files which name none, and that of all else.
enum class LookOrder : std::uint32_t { Documented, SceneLinear };

/// The rest of the table [ui]: what the interface is.
struct LookUi {
    std::string document;                  ///< file name of a picture or an SVG document, relative to the look
    std::vector<std::string> controllers;  ///< of Lua scripts, the same
    /// What the document's bindings show, and controllers read, until the game says something else.
    GameTable game;
};

/// A key of a flat table that its file writes.
struct WrittenValue {
    const EffectInfo* effect = nullptr;
    std::string_view parameter;  ///< the row's name, or "enabled"
    std::string place{};         ///< "line:column"
};

struct Look {
    static constexpr std::int64_t format = 1;  ///< of the files that this build reads and writes
    bool is_flat = true;                       ///< [post_process]; false: [[stack]]
    bool was_flat = false;                     ///< a stack that place_entry made of a flat table
    bool is_enabled = true;                    ///< flat only; false: its exposure, tone mapping and encoding alone
    LookOrder order = LookOrder::SceneLinear;  ///< flat only
    std::vector<LookEntry> entries;            ///< flat: every effect with a place in the tables
    std::vector<WrittenValue> written{};       ///< flat only: what a file says of the effects
    std::optional<LookUi> ui{};                ///< there is a table [ui]
    std::vector<LookPulse> pulses;
    std::vector<LookLayer> layers;  ///< in the order they are blended
    std::string shown_name;         ///< file name for messages
};

/// What is in a file that a look names; errors begin with the path.
using ResourceLoader = std::function<Result<ResourceData>(const std::filesystem::path& path, FileUse use)>;

struct LookOptions {
    bool is_strict = false;                        ///< unknown keys and values out of range are errors, not warnings
    std::vector<std::string>* warnings = nullptr;  ///< "file:line:column: ..." of what was passed over
    bool is_scene = false;                         ///< the file is a scene: its other tables are no slips
    /// Entries may name files (`effect = "duotone.glsl"`). These are code, and may keep a GPU busy for ever: a host
    /// that allows them trusts whoever made the look.
    bool allows_custom_effects = false;
    bool allows_modulation = true;   ///< false: [[pulse]] and [[layer]] are passed over, as in the look of a layer
    ResourceLoader load_resource{};  ///< none: colour tables in .cube files alone
    bool reads_tables = true;        ///< false: no .cube file is read, either; load_resource brings all
    /// Numbers in all tables and pictures that the look names together: two of the largest tables.
    std::size_t max_resource_numbers = std::size_t{1} << 27;
    std::filesystem::path folder;  ///< that files are relative to; empty: read_look takes the look's own
};

/// The flat table with nothing written in it but its order.
[[nodiscard]] Look default_look(LookOrder order = LookOrder::SceneLinear);
/// The same for pictures that a path tracer or a camera made: without EffectInfo::is_in_traced_light.
[[nodiscard]] Look default_look_of_traced_light();
/// An effect's entry there: at its defaults, or in the documented order at those of files/looks/documented.hpp.
[[nodiscard]] LookEntry flat_entry(const EffectInfo& effect, LookOrder order);
/// Of a flat look: values that are the defaults of its order become those of the new one.
void set_order(Look& look, LookOrder order);
/// What remains of a look where post-processing is off: its exposure, tone mapping and encoding at their defaults, and
/// the interface.
[[nodiscard]] Look switched_off(const Look& look);
/// The multiplier of the scene's light that the look has; 1: it has none.
[[nodiscard]] float exposure_of(const Look& look);
/// Gives a look the interface's own chain, at its defaults where it has none: what an empty table [ui] does.
void add_ui(Look& look);
/// Errors and warnings are `shown_name:line:column: thing, value, what is allowed, nearest name`. The files that a look
/// names are read with it.
[[nodiscard]] Result<Look> parse_look(std::string_view text, std::string shown_name, const LookOptions& options = {});
[[nodiscard]] Result<Look> read_look(const std::filesystem::path& path, const LookOptions& options = {});
/// Lays what a file writes in [post_process] over a look, and leaves all else as it is: the order, too. An effect that
/// a stack lacks gets a place, as by place_entry. Errors: read_look's; there is no such value; a value and those of the
/// look cannot be together.
[[nodiscard]] Result<> lay_over(Look& look, const std::filesystem::path& file, const LookOptions& options = {});
/// An entry of the effect in this file (darkroom/custom_effect.hpp), at its defaults.
[[nodiscard]] Result<LookEntry> custom_entry(const std::filesystem::path& file);
/// Puts an entry behind the last place where the picture is in a domain that its effect accepts. A flat table becomes
/// the stack that it stands for, without what is off. Errors: there is no such place; another effect has its name.
[[nodiscard]] Result<> place_entry(Look& look, LookEntry entry);
/// As a file that reads back as the same look, where it lies in the same folder.
[[nodiscard]] std::string write_look(const Look& look);

/// The name of each entry: its own, or the effect's, or effect#2 and so on for later ones.
[[nodiscard]] std::vector<std::string> entry_names(const Look& look);
/// By its own name, or by "effect" or "effect#2": the second entry of that effect.
[[nodiscard]] LookEntry* find_entry(Look& look, std::string_view name);

/// A value from the command line. It wins over the file.
struct LookOverride {
    std::string key;    ///< "bloom_intensity", "bloom_enabled", or "ENTRY.parameter": "bloom#2.intensity"
    std::string text;   ///< the value, as typed
    std::string shown;  ///< what the user typed, for errors: "--bloom-intensity"
};
/// Checks and applies all of them, in order. A value above 0 for an effect's main amount turns it on, 0 turns it off,
/// unless `<effect>_enabled` is among them. Of the options, that which loads files counts: their names are relative to
/// the working directory.
[[nodiscard]] Result<> override_look(Look& look, std::span<const LookOverride> overrides,
                                     const LookOptions& options = {});

/// A sentence for each entry that is off and has a value, in the look's file or among `typed`, where nothing beside
/// that value says whether it should be on: "my.toml:3:1: vignette_smoothness changes nothing: vignette is off; ...".
[[nodiscard]] std::vector<std::string> values_without_effect(const Look& look,
                                                             std::span<const LookOverride> typed = {});

struct ApplyOptions {
    /// Gives effects of the flat table that are off their place, so that Composer::set_enabled() finds them: they own
    /// images then, and those with passes part kernels. Those that move coordinates by nothing have none in any case.
    bool keeps_what_is_off = false;
    /// The same for entries of these names: what a timeline may switch on. Entries that a pulse or a layer moves are
    /// there in any case.
    std::span<const std::string> keeps{};
};
/// Appends the look's entries, pulses and layers to the Composer. The flat table wires `source` to the scene, as its
/// documented order has it, and of its effects that are off those with images or passes get no place.
[[nodiscard]] Result<> apply(const Look& look, Composer& composer, const ApplyOptions& options = {});

/// What follow() did.
struct Followed {
    /// The next record() sees values, toggles and opacities; all of the rest only a compile (compile_later).
    bool needs_compile = false;
};
/// Takes a Composer that holds one look to another: it then holds what apply() with the same options makes of `is`.
/// Entries of both looks keep their handles, histories, overrides and what moves them. Base values are the look's, also
/// where others have set them meanwhile. An error changes nothing.
[[nodiscard]] Result<Followed> follow(const Look& was, const Look& is, Composer& composer,
                                      const ApplyOptions& options = {});

}  // namespace darkroom
