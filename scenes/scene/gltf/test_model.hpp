// SPDX-License-Identifier: MIT
#pragma once
// For tests: a glTF file put together in code, its data in a data URI.

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/text/markup.hpp"

namespace darkroom::scene {

inline std::string base64(std::string_view bytes) { return darkroom::base64(std::as_bytes(std::span(bytes))); }

class TestModel {
  public:
    nlohmann::json json{{"asset", {{"version", "2.0"}}}};
    std::string bytes;

    /// Adds a bufferView with the values and gives its index.
    template <class T>
    std::size_t view(const std::vector<T>& values) {
        while (bytes.size() % 4 != 0) bytes += '\0';
        json["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(T)}});
        bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
        return json["bufferViews"].size() - 1;
    }

    /// Adds an accessor of all the values and gives its index.
    template <class T>
    std::size_t accessor(const std::vector<T>& values, const char* type, bool is_normalized = false) {
        std::size_t components = 1;
        if (type == std::string_view("MAT4")) components = 16;
        if (std::string_view(type).starts_with("VEC")) components = static_cast<std::size_t>(type[3] - '0');
        nlohmann::json accessor{{"bufferView", view(values)},
                                {"componentType", component_type<T>()},
                                {"count", values.size() / components},
                                {"type", type}};
        if (is_normalized) accessor["normalized"] = true;
        json["accessors"].push_back(std::move(accessor));
        return json["accessors"].size() - 1;
    }

    /// A triangle in a mesh of a node; further attributes can be added to the result.
    nlohmann::json& add_triangle(const std::vector<float>& positions = {0, 0, 0, 1, 0, 0, 0, 1, 0}) {
        const std::size_t accessor_index = accessor<float>(positions, "VEC3");
        json["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", accessor_index}}}}}}});
        json["nodes"].push_back({{"mesh", json["meshes"].size() - 1}});
        return json["meshes"].back()["primitives"][0];
    }

    /// A figure of one joint, 180 high along y, under a node that makes centimetres along z metres along y of it.
    void add_figure() {
        auto& primitive = add_triangle({0, 0, 0, 60, 0, 0, 0, 180, 20});
        primitive["attributes"]["JOINTS_0"] = accessor<std::uint8_t>(std::vector<std::uint8_t>(12), "VEC4");
        primitive["attributes"]["WEIGHTS_0"] = accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
        json["nodes"][0]["skin"] = 0;
        json["nodes"].push_back(
            {{"scale", {0.01, 0.01, 0.01}}, {"rotation", {-0.70710678, 0, 0, 0.70710678}}, {"children", {2}}});
        json["nodes"].push_back({{"name", "hips"}});
        json["skins"] = {{{"joints", {2}}}};
    }

    [[nodiscard]] std::string text() {
        if (!bytes.empty() && !json.contains("buffers"))
            json["buffers"] = {
                {{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}};
        return json.dump();
    }

  private:
    template <class T>
    static int component_type() {
        if constexpr (std::is_same_v<T, std::int8_t>) return 5120;
        if constexpr (std::is_same_v<T, std::uint8_t>) return 5121;
        if constexpr (std::is_same_v<T, std::int16_t>) return 5122;
        if constexpr (std::is_same_v<T, std::uint16_t>) return 5123;
        if constexpr (std::is_same_v<T, std::uint32_t>) return 5125;
        return 5126;
    }
};

}  // namespace darkroom::scene
