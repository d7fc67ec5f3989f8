// SPDX-License-Identifier: MIT
#include "document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include "scene/gltf/tables.hpp"

namespace darkroom::scene::gltf {

namespace {

// Which extensions of glTF 2.0 are read here, and what a model looks like without some of those that are not. An
// extension that is learnt moves from the second list to the first.

inline constexpr auto read_extensions = std::to_array<std::string_view>({
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
});

/// What happens without one that a file may do without.
struct MissingExtension {
    std::string_view name, consequence;
};

inline constexpr auto missing_extensions = std::to_array<MissingExtension>({
    {"EXT_lights_image_based", "light of the model's own surroundings is left out"},
    {"KHR_animation_pointer", "only nodes and morph targets are animated"},
    {"KHR_materials_anisotropy", "highlights are round"},
    {"KHR_materials_diffuse_transmission", "no light comes through its surfaces"},
    {"KHR_materials_dispersion", "colours are not split"},
    {"KHR_materials_iridescence", "thin films are left out"},
    {"KHR_materials_pbrSpecularGlossiness", "surfaces are drawn by their metallic-roughness values, or white"},
    {"KHR_materials_transmission", "glass is opaque"},
    {"KHR_materials_volume", "nothing absorbs light inside"},
    {"KHR_node_visibility", "hidden nodes are drawn"},
    {"KHR_texture_basisu", "textures are read from their other images, or left out"},
    {"MSFT_lod", "the finest level is drawn"},
    {"MSFT_texture_dds", "textures are read from their other images, or left out"},
});

inline bool is_read_extension(std::string_view name) {
    return std::ranges::find(read_extensions, name) != read_extensions.end();
}

/// Empty where nothing is known of it.
inline std::string_view consequence_without(std::string_view name) {
    const auto found = std::ranges::find(missing_extensions, name, &MissingExtension::name);
    return found == missing_extensions.end() ? std::string_view() : found->consequence;
}

using nlohmann::json;

// Enough to see what is wrong with a file, however much of it is.
constexpr std::size_t max_warnings = 20;

std::string shown(const json& value) {
    std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
    return text.size() > 40 ? text.substr(0, 37) + "..." : text;
}

std::string shown_range(double low, double high) {
    if (!std::isfinite(high)) return fmt::format("at least {}", low);
    return fmt::format("{} to {}", low, high);
}

// Whole numbers may be written 1.0; the parsing library wants them without the point.
bool make_integer(json& value) {
    if (value.is_number_unsigned()) return value.get<std::uint64_t>() <= max_integer;
    if (value.is_number_integer()) return value.get<std::int64_t>() >= -static_cast<std::int64_t>(max_integer);
    if (!value.is_number_float()) return false;
    const double number = value.get<double>();
    if (!(std::abs(number) <= static_cast<double>(max_integer)) || number != std::floor(number)) return false;
    value = static_cast<std::int64_t>(number);
    return true;
}

bool is_finite_number(const json& value) {
    return value.is_number() && std::abs(value.get<double>()) <= std::numeric_limits<float>::max();
}

class Checker {
  public:
    Checker(const json& root, Faults& faults) : faults_(faults) {
        for (const Array& array : arrays)
            if (const auto found = root.find(array.name); found != root.end() && found->is_array())
                sizes_[std::string(array.name)] = found->size();
        for (const auto& [extension, array] :
             {std::pair{"KHR_lights_punctual", "lights"}, std::pair{"KHR_materials_variants", "variants"}})
            if (const auto* found = find_array(root, extension, array)) sizes_[array] = found->size();
    }

    /// Of an extension of the root.
    static const json* find_array(const json& root, const char* extension, const char* array) {
        const auto extensions = root.find("extensions");
        if (extensions == root.end() || !extensions->is_object()) return nullptr;
        const auto object = extensions->find(extension);
        if (object == extensions->end() || !object->is_object()) return nullptr;
        const auto found = object->find(array);
        return found == object->end() || !found->is_array() ? nullptr : &*found;
    }

    // Elements that cannot be used are replaced by the placeholder.
    void check_array(json& array, const Definition& definition, std::string_view placeholder,
                     const std::string& pointer) {
        const std::string_view array_name = std::string_view(pointer).substr(pointer.rfind('/') + 1);
        if (array.empty()) faults_.warn(fmt::format("{}: is empty, at least one element is needed", pointer));
        for (std::size_t i = 0; i < array.size(); ++i) {
            element_ = fmt::format("{}/{}", pointer, i);
            const bool is_good = check_object(array[i], definition, element_) && check_choices(array[i], array_name);
            if (!is_good) array[i] = json::parse(placeholder);
        }
    }

    void check_root(const json& root) { check_extension_types(root, ""); }

  private:
    // false: the object that holds the value cannot be used.
    bool refuse(const Property& property, const std::string& pointer, const std::string& what) {
        if (property.is_required || is_vital(property.kind)) {
            faults_.add(element_, fmt::format("{}: {}", pointer, what));
            return false;
        }
        faults_.warn(fmt::format("{}: {}; it is passed over", pointer, what));
        return true;
    }

    static bool is_vital(Kind kind) {
        return kind == Kind::Integer || kind == Kind::Index || kind == Kind::Indices || kind == Kind::IndexMap ||
               kind == Kind::IndexMaps || kind == Kind::IntegerMap || kind == Kind::Object || kind == Kind::Objects;
    }

    bool check_object(json& object, const Definition& definition, const std::string& pointer) {
        if (!object.is_object()) {
            faults_.add(element_, fmt::format("{}: {}, an object is needed", pointer, shown(object)));
            return false;
        }
        check_extension_types(object, pointer);
        json kept = json::object();
        for (const Property& property : definition.properties) {
            const auto found = object.find(property.name);
            const std::string place = fmt::format("{}/{}", pointer, property.name);
            if (found == object.end()) {
                if (!property.is_required) continue;
                faults_.add(element_, fmt::format("{}: is missing", place));
                return false;
            }
            bool is_kept = true;
            if (!check_value(*found, property, place, is_kept)) return false;
            if (is_kept) kept[std::string(property.name)] = std::move(*found);
        }
        object = std::move(kept);
        return true;
    }

    void check_extension_types(const json& object, const std::string& pointer) {
        const auto extensions = object.find("extensions");
        if (extensions == object.end()) return;
        if (!extensions->is_object())
            return faults_.warn(fmt::format("{}/extensions: {}, an object is needed", pointer, shown(*extensions)));
        for (const auto& [name, extension] : extensions->items())
            if (!extension.is_object())
                faults_.warn(fmt::format("{}/extensions/{}: {}, an object is needed", pointer, name, shown(extension)));
    }

    // What the library refuses a whole file for.
    bool check_choices(const json& object, std::string_view array) {
        const auto refuse_unless = [&](bool is_good, std::string_view property, std::string_view allowed) {
            if (!is_good)
                faults_.add(
                    element_,
                    fmt::format("{}/{}: {}, allowed is {}", element_, property,
                                object.contains(property) ? shown(object[std::string(property)]) : "missing", allowed));
            return is_good;
        };
        const auto is_one_of = [&](const char* property, std::initializer_list<std::string_view> choices) {
            const auto value = object[property].get<std::string>();
            return std::find(choices.begin(), choices.end(), value) != choices.end();
        };
        if (array == "accessors") {
            const int type = object["componentType"].get<int>();
            return refuse_unless(type != 5124, "componentType", "5120 to 5123, 5125 and 5126") &&
                   refuse_unless(is_one_of("type", {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"}), "type",
                                 "SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 and MAT4");
        }
        if (array == "bufferViews")
            return refuse_unless(!object.contains("byteStride") || object["byteStride"].get<int>() % 4 == 0,
                                 "byteStride", "multiples of 4");
        if (array == "cameras" && object.contains("perspective") && object.contains("orthographic"))
            faults_.warn(fmt::format("{}: is perspective and also orthographic; type says which", element_));
        if (array == "cameras")
            return refuse_unless(is_one_of("type", {"perspective", "orthographic"}), "type",
                                 "perspective and orthographic") &&
                   refuse_unless(object.contains(object["type"].get<std::string>()), object["type"].get<std::string>(),
                                 "an object");
        const bool has_parts =
            object.contains("translation") || object.contains("rotation") || object.contains("scale");
        if (array == "nodes" && object.contains("matrix") && has_parts)
            faults_.warn(fmt::format("{}: has a matrix and also its parts; the matrix is used", element_));
        if (array == "lights")
            return refuse_unless(is_one_of("type", {"directional", "point", "spot"}), "type",
                                 "directional, point and spot");
        return true;
    }

    bool check_number(const json& value, const Property& property, const std::string& pointer) {
        const double number = value.get<double>();
        if (number < property.low || number > property.high)
            faults_.warn(
                fmt::format("{}: {}, allowed is {}", pointer, shown(value), shown_range(property.low, property.high)));
        return true;
    }

    bool check_integer(json& value, const Property& property, const std::string& pointer, bool& is_kept) {
        const bool is_whole = make_integer(value);
        if (is_whole && value.get<double>() >= property.low && value.get<double>() <= property.high) return true;
        is_kept = false;
        return refuse(
            property, pointer,
            fmt::format("{}, a whole number, {}, is needed", shown(value), shown_range(property.low, property.high)));
    }

    bool check_index(json& value, const Property& property, const std::string& pointer, bool& is_kept) {
        const std::size_t size = sizes_.contains(property.target) ? sizes_.find(property.target)->second : 0;
        if (!make_integer(value)) {
            is_kept = false;
            return refuse(property, pointer, fmt::format("{}, an index is needed", shown(value)));
        }
        if (value.get<std::int64_t>() >= 0 && value.get<std::uint64_t>() < size) return true;
        is_kept = false;
        return refuse(property, pointer, fmt::format("{}, there are {} {}", shown(value), size, property.target));
    }

    bool check_indices(json& value, const Property& property, const std::string& pointer, bool& is_kept) {
        if (!value.is_array()) return refuse(property, pointer, fmt::format("{}, an array is needed", shown(value)));
        if (value.empty()) faults_.warn(fmt::format("{}: is empty", pointer));
        for (std::size_t i = 0; i < value.size(); ++i)
            if (!check_index(value[i], property, fmt::format("{}/{}", pointer, i), is_kept)) return false;
        return true;
    }

    bool check_map(json& value, const Property& property, const std::string& pointer, bool& is_kept) {
        if (!value.is_object()) return refuse(property, pointer, fmt::format("{}, an object is needed", shown(value)));
        if (value.empty()) faults_.warn(fmt::format("{}: is empty", pointer));
        for (auto& [name, number] : value.items()) {
            const std::string place = fmt::format("{}/{}", pointer, name);
            const bool is_good = property.kind == Kind::IntegerMap ? check_integer(number, property, place, is_kept)
                                                                   : check_index(number, property, place, is_kept);
            if (!is_good) return false;
        }
        return true;
    }

    bool check_numbers(const json& value, const Property& property, const std::string& pointer, bool& is_kept) {
        const bool is_good = value.is_array() && std::all_of(value.begin(), value.end(), is_finite_number) &&
                             (property.count == 0 || value.size() == property.count);
        if (!is_good) {
            is_kept = false;
            const std::string wanted = property.count == 0 ? "" : fmt::format("{} ", property.count);
            return refuse(property, pointer, fmt::format("{}, {}numbers are needed", shown(value), wanted));
        }
        if (value.empty()) faults_.warn(fmt::format("{}: is empty", pointer));
        return std::all_of(value.begin(), value.end(),
                           [&](const json& number) { return check_number(number, property, pointer); });
    }

    bool check_value(json& value, const Property& property, const std::string& pointer, bool& is_kept) {
        const auto wrong = [&](std::string_view wanted) {
            is_kept = false;
            return refuse(property, pointer, fmt::format("{}, {} is needed", shown(value), wanted));
        };
        switch (property.kind) {
            case Kind::Boolean:
                return value.is_boolean() || wrong("true or false");
            case Kind::Integer:
            case Kind::LooseInteger:
                return check_integer(value, property, pointer, is_kept);
            case Kind::Number:
                return is_finite_number(value) ? check_number(value, property, pointer) : wrong("a number");
            case Kind::Numbers:
                return check_numbers(value, property, pointer, is_kept);
            case Kind::Text:
                return value.is_string() || wrong("a string");
            case Kind::Index:
            case Kind::UnusedIndex:
                return check_index(value, property, pointer, is_kept);
            case Kind::Indices:
                return check_indices(value, property, pointer, is_kept);
            case Kind::IndexMap:
            case Kind::IntegerMap:
                return check_map(value, property, pointer, is_kept);
            case Kind::IndexMaps:
            case Kind::Objects:
                break;
            case Kind::Object:
                return check_object(value, *property.object, pointer);
        }
        if (!value.is_array()) return wrong("an array");
        if (value.empty()) faults_.warn(fmt::format("{}: is empty, at least one element is needed", pointer));
        for (std::size_t i = 0; i < value.size(); ++i) {
            const std::string place = fmt::format("{}/{}", pointer, i);
            const bool is_good = property.kind == Kind::Objects ? check_object(value[i], *property.object, place)
                                                                : check_map(value[i], property, place, is_kept);
            if (!is_good) return false;
        }
        return true;
    }

    Faults& faults_;
    std::map<std::string, std::size_t, std::less<>> sizes_;
    std::string element_;
};

Result<> check_asset(const json& root, Faults& faults) {
    const auto asset = root.find("asset");
    if (asset == root.end() || !asset->is_object()) return user_error("/asset: is missing, with the version of glTF");
    const auto version = asset->find("version");
    if (version == asset->end() || !version->is_string()) return user_error("/asset/version: is missing");
    const auto text = version->get<std::string>();
    if (!text.starts_with("2."))
        return user_error(fmt::format("/asset/version: {}, 2.0 is read here", shown(*version)));
    const auto least = asset->find("minVersion");
    if (least == asset->end()) return {};
    if (!least->is_string() || !least->get<std::string>().starts_with("2."))
        return user_error(fmt::format("/asset/minVersion: {}, 2.0 is read here", shown(*least)));
    if (least->get<std::string>() > text)
        faults.warn(fmt::format("/asset/minVersion: {} is above the version {}", shown(*least), shown(*version)));
    return {};
}

Result<> check_extensions(const json& root, Faults& faults) {
    for (const char* name : {"extensionsUsed", "extensionsRequired"}) {
        const auto found = root.find(name);
        if (found == root.end()) continue;
        const bool is_required = std::string_view(name) == "extensionsRequired";
        if (!found->is_array()) {
            faults.warn(fmt::format("/{}: {}, an array is needed", name, shown(*found)));
            continue;
        }
        if (found->empty()) faults.warn(fmt::format("/{}: is empty", name));
        for (std::size_t i = 0; i < found->size(); ++i) {
            const json& extension = (*found)[i];
            const std::string place = fmt::format("/{}/{}", name, i);
            if (!extension.is_string()) {
                faults.warn(fmt::format("{}: {}, a string is needed", place, shown(extension)));
                continue;
            }
            const auto known = extension.get<std::string>();
            if (is_read_extension(known)) continue;
            if (is_required)
                return user_error(fmt::format("{}: {} is required and not read here", place, shown(extension)));
            const std::string_view consequence = consequence_without(known);
            faults.warn(fmt::format("{}: {} is not read here{}{}", place, shown(extension),
                                    consequence.empty() ? "" : ": ", consequence));
        }
    }
    return {};
}

}  // namespace

void Faults::warn(std::string text) {
    if (warnings_.size() > max_warnings || contains(text)) return;
    warnings_.push_back(std::move(text));
}

// A fault is told once, though much may depend on it.
bool Faults::contains(std::string_view text) const {
    return std::any_of(warnings_.begin(), warnings_.end(),
                       [&](const std::string& warning) { return warning.find(text) != std::string::npos; });
}

void Faults::add(const std::string& element, std::string text) {
    if (faults_.emplace(element, std::move(text)).second) order_.push_back(element);
}

Result<> Faults::check(const std::string& element) {
    const auto found = faults_.find(element);
    if (found == faults_.end()) return {};
    return user_error(found->second);
}

std::vector<std::string> Faults::take_warnings() {
    for (const std::string& element : order_) warn(faults_.at(element));
    if (warnings_.size() > max_warnings) {
        warnings_.resize(max_warnings);
        warnings_.emplace_back("there are more faults");
    }
    return std::move(warnings_);
}

Result<> check_structure(json& root, Faults& faults, Budget& budget) {
    DARKROOM_TRY(check_asset(root, faults));
    DARKROOM_TRY(check_extensions(root, faults));
    Checker checker(root, faults);
    checker.check_root(root);
    json kept = json::object();
    kept["asset"] = {{"version", "2.0"}};
    for (const Array& array : arrays) {
        const auto found = root.find(array.name);
        if (found == root.end()) continue;
        if (!found->is_array())
            return user_error(fmt::format("/{}: {}, an array is needed", array.name, shown(*found)));
        const std::string pointer = fmt::format("/{}", array.name);
        DARKROOM_TRY(budget.take(pointer, "elements", found->size(), array.element_size));
        checker.check_array(*found, *array.definition, array.placeholder, pointer);
        kept[std::string(array.name)] = std::move(*found);
    }
    if (const json* variants = Checker::find_array(root, "KHR_materials_variants", "variants")) {
        const std::string_view pointer = "/extensions/KHR_materials_variants/variants";
        DARKROOM_TRY(budget.take(pointer, "elements", variants->size(), element_size));
        json copy = *variants;
        checker.check_array(copy, variant_definition, R"({"name":""})", std::string(pointer));
        kept["extensions"]["KHR_materials_variants"]["variants"] = std::move(copy);
    }
    if (const json* lights = Checker::find_array(root, "KHR_lights_punctual", "lights")) {
        DARKROOM_TRY(budget.take("/extensions/KHR_lights_punctual/lights", "elements", lights->size(), element_size));
        json copy = *lights;
        checker.check_array(copy, light_definition, light_placeholder, "/extensions/KHR_lights_punctual/lights");
        for (json& light : copy)
            if (light["type"] == "spot" && !light.contains("spot")) light["spot"] = json::object();
        kept["extensions"]["KHR_lights_punctual"]["lights"] = std::move(copy);
    }
    if (const auto scene = root.find("scene"); scene != root.end()) {
        const std::size_t count = kept.contains("scenes") ? kept["scenes"].size() : 0;
        if (!make_integer(*scene) || scene->get<std::int64_t>() < 0 || scene->get<std::uint64_t>() >= count)
            return user_error(fmt::format("/scene: {}, there are {} scenes", shown(*scene), count));
        kept["scene"] = std::move(*scene);
    }
    kept["extensionsUsed"] = json::array();
    if (const auto used = root.find("extensionsUsed"); used != root.end() && used->is_array())
        for (json& extension : *used)
            if (extension.is_string()) kept["extensionsUsed"].push_back(std::move(extension));
    root = std::move(kept);
    return {};
}

}  // namespace darkroom::scene::gltf
