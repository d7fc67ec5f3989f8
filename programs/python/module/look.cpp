// SPDX-License-Identifier: MIT
// Looks as Python edits them. Values come as text, as from a command line, so that all checks are those of
// override_look; tables and pictures come as they are.
#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <darkroom/custom_effect.hpp>
#include <darkroom/look.hpp>
#include <map>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "core/text/param_text.hpp"
#include "looks/look_parts.hpp"
#include "parts.hpp"
#include "tables/cube_file.hpp"

namespace darkroom::python {

namespace py = pybind11;

namespace {

using Data = std::shared_ptr<const ResourceData>;
using Values = std::vector<std::pair<std::string, py::object>>;

/// What a resource that is no file is called; the dot makes a wire take it for one.
constexpr std::string_view in_memory = "in_memory.";

std::uint64_t next_edition() {
    static std::atomic<std::uint64_t> last = 0;
    return ++last;
}

EditedLook edited(Look look, std::vector<LookOverride> typed = {}) {
    return {std::move(look), std::move(typed), next_edition()};
}

Data data_of(const py::object& object, std::string_view name) {
    if (py::isinstance<PyTable>(object)) return object.cast<const PyTable&>().data;
    return std::make_shared<const ResourceData>(image_of(read_layer(object, {.name = name})));
}

/// The files that a look names: tables in .cube files are read here, all else by darkroom.files.
class Loader {
  public:
    /// The name that stands for it.
    std::string add(const py::object& object, std::string_view name) {
        std::string out = fmt::format("{}{}", in_memory, next_edition());
        given_.emplace(out, data_of(object, name));
        return out;
    }
    Result<ResourceData> load(const std::filesystem::path& path, FileUse use) const try {
        if (const auto found = given_.find(path.string()); found != given_.end()) return *found->second;
        if (use == FileUse::Table && path.extension() == ".cube") {
            DARKROOM_TRY_VALUE(TableFile file, read_cube(path));
            return ResourceData(std::move(file.table));
        }
        const py::object load = py::module_::import("darkroom.files").attr("load_resource");
        return *data_of(load(path.string(), use == FileUse::Table), path.string());
    } catch (py::error_already_set& error) {
        if (py::hasattr(error.value(), "text")) return user_error(py::str(error.value().attr("text")));
        return user_error(py::str(error.value()));
    }
    LookOptions options(bool allows_custom_effects, std::vector<std::string>* warnings) const {
        return {.warnings = warnings,
                .allows_custom_effects = allows_custom_effects,
                .load_resource = [this](const std::filesystem::path& path, FileUse use) { return load(path, use); }};
    }

  private:
    std::map<std::string, Data> given_;
};

/// `keys` as find_target reads them; `shown` is put before them in errors.
/// What is set goes behind what was `typed` before.
void set_values(Look& look, std::vector<LookOverride>& typed, const std::string& entry, const std::string& shown,
                const Values& values) {
    Loader loader;
    std::vector<LookOverride> overrides;
    for (const auto& [key, value] : values) {
        const std::string name = fmt::format("{}.{}", shown, key);
        std::string text = py::isinstance<py::str>(value) ? std::string(py::str(value)) : loader.add(value, name);
        overrides.push_back({entry.empty() ? key : fmt::format("{}.{}", entry, key), std::move(text), name});
    }
    must(override_look(look, overrides, loader.options(false, nullptr)));
    const std::vector<LookProblem> problems = problems_of(look, [&](std::size_t i) { return entry_names(look)[i]; });
    if (!problems.empty()) raise_user(fmt::format("{}: {}", look.shown_name, problems.front().text));
    for (LookOverride& one : overrides) {
        std::erase_if(typed, [&](const LookOverride& other) { return other.key == one.key; });
        typed.push_back({std::move(one.key), {}, std::move(one.shown)});
    }
}

LookEntry entry_named(const std::string& effect) {
    if (effect.ends_with(".glsl")) return must(custom_entry(effect));
    if (const EffectInfo* const info = find_effect(effect)) return entry_of(*info);
    std::vector<std::string> names;
    for (const EffectInfo* const known : all_effects()) names.emplace_back(known->name);
    raise_user(fmt::format("no effect '{}'{}", printable(effect), alternatives(effect, names, "there are")));
}

/// Gives the new entry's name.
std::string add_entry(EditedLook& edits, const std::string& effect, const std::string& name, const std::string& output,
                      const Values& values) {
    Look look = edits.look;
    LookEntry entry = entry_named(effect);
    const std::string shown(entry.effect->name);
    for (const auto& [key, text] : {std::pair("name", &name), std::pair("output", &output)})
        if (!text->empty() && !is_look_name(*text))
            raise_user(fmt::format("{}.{} = \"{}\": allowed are letters, digits, '_' and '-', up to 64", shown, key,
                                   printable(*text)));
    entry.name = name;
    entry.output = output;
    const std::uint64_t id = entry.id = next_edition();
    if (look.is_flat) {
        must(place_entry(look, std::move(entry)));
    } else {
        if (const Result<> shared = share_effect(look, entry); !shared) raise(shared.error());
        look.entries.push_back(std::move(entry));
    }
    const auto place = std::ranges::find(look.entries, id, &LookEntry::id);
    // From here on its name tells it from others: a stack that is made anew for each picture is not compiled anew.
    place->id = 0;
    std::string made = entry_names(look)[static_cast<std::size_t>(place - look.entries.begin())];
    set_values(look, edits.typed, made, made, values);
    edits = edited(std::move(look), std::move(edits.typed));
    return made;
}

void set_entry(EditedLook& edits, const std::string& entry, const Values& values) {
    Look look = edits.look;
    set_values(look, edits.typed, entry, entry.empty() ? look.shown_name : entry, values);
    edits = edited(std::move(look), std::move(edits.typed));
}

LookEntry& entry_of_name(Look& look, const std::string& name) {
    if (LookEntry* const found = find_entry(look, name)) return *found;
    const std::vector<std::string> names = entry_names(look);
    raise_user(
        fmt::format("{}: no entry '{}'{}", look.shown_name, printable(name), alternatives(name, names, "it has")));
}

void remove_entry(EditedLook& edits, const std::string& name) {
    Look look = edits.look;
    if (look.is_flat)
        raise_user(fmt::format("{}: a flat table keeps its entries: switch '{}' off", look.shown_name, name));
    const LookEntry& entry = entry_of_name(look, name);
    look.entries.erase(look.entries.begin() + (&entry - look.entries.data()));
    edits = edited(std::move(look), std::move(edits.typed));
}

py::dict values_of(EditedLook& edits, const std::string& name) {
    const LookEntry& entry = entry_of_name(edits.look, name);
    py::dict out;
    for (const ParamInfo& row : entry.effect->parameters.rows) {
        const auto found = std::ranges::find(entry.resources, row.name, &LookResource::parameter);
        out[py::str(std::string(row.name))] =
            found == entry.resources.end() ? value_of(row, entry.words) : py::cast(PyTable{found->data, found->file});
    }
    const StateWords words = state_words(entry.state);
    for (const ParamInfo& row : entry_rows.rows) out[py::str(std::string(row.name))] = value_of(row, words);
    return out;
}

std::string look_text(const EditedLook& edits) {
    for (const LookEntry& entry : edits.look.entries)
        for (const LookResource& resource : entry.resources)
            if (resource.file.starts_with(in_memory))
                raise_user(fmt::format("{}: {}.{} is in memory: a look names files, so write it to one and name that",
                                       edits.look.shown_name, entry.effect->name, resource.parameter));
    return write_look(edits.look);
}

/// The look, and what was passed over.
template <class Read>
std::pair<EditedLook, std::vector<std::string>> read_with(bool allows_custom_effects, const Read& read) {
    const Loader loader;
    std::vector<std::string> warnings;
    Look look = must(read(loader.options(allows_custom_effects, &warnings)));
    return {edited(std::move(look)), std::move(warnings)};
}

}  // namespace

void add_looks(py::module_& module) {
    py::class_<EditedLook>(module, "Look")
        .def(py::init([] {
            Look look;
            look.is_flat = false;
            look.shown_name = "stack";
            return edited(std::move(look));
        }))
        .def_static("default", [] { return edited(default_look_of_traced_light()); })
        .def_static("read",
                    [](const std::string& path, bool allows_custom_effects) {
                        return read_with(allows_custom_effects,
                                         [&](const LookOptions& options) { return read_look(path, options); });
                    })
        .def_static("parse",
                    [](const std::string& text, const std::string& name, bool allows_custom_effects) {
                        return read_with(allows_custom_effects,
                                         [&](const LookOptions& options) { return parse_look(text, name, options); });
                    })
        .def("copy", [](const EditedLook& edits) { return edits; })
        .def("add", &add_entry)
        .def("set", &set_entry)
        .def("remove", &remove_entry)
        .def("values", &values_of)
        .def("text", &look_text)
        .def("values_without_effect",
             [](const EditedLook& edits) { return values_without_effect(edits.look, edits.typed); })
        .def_property_readonly("is_flat", [](const EditedLook& edits) { return edits.look.is_flat; })
        .def_property_readonly("names", [](const EditedLook& edits) { return entry_names(edits.look); })
        .def("effect_of", [](EditedLook& edits, const std::string& name) {
            return std::string(entry_of_name(edits.look, name).effect->name);
        });
}

}  // namespace darkroom::python
