// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/files.hpp"
#include "image/camera/camera_check.hpp"
#include "image/frame/frame_file.hpp"
#include "toml/toml_text.hpp"

namespace darkroom {
namespace {

std::optional<double> number(const toml::node& node) { return node.value<double>(); }

// Written by rows, kept by columns.
std::optional<Matrix> matrix(const toml::node& node) {
    const toml::array* rows = node.as_array();
    if (rows == nullptr || rows->size() != 16) return std::nullopt;
    Matrix result{};
    for (std::size_t i = 0; i < 16; ++i) {
        const auto value = number(*rows->get(i));
        if (!value) return std::nullopt;
        result[i % 4 * 4 + i / 4] = static_cast<float>(*value);
    }
    return result;
}

// The inverse of a rotation and a translation; a camera is not scaled.
std::optional<Matrix> rigid_inverse(const Matrix& m) {
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || std::abs(m[15] - 1) > 1e-2f) return std::nullopt;
    Matrix result{};
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column) {
            result[column * 4 + row] = m[row * 4 + column];
            float dot = 0;
            for (std::size_t i = 0; i < 3; ++i) dot += m[row * 4 + i] * m[column * 4 + i];
            if (std::abs(dot - (row == column ? 1.0f : 0.0f)) > 1e-2f) return std::nullopt;
            result[12 + row] -= m[row * 4 + column] * m[12 + column];
        }
    }
    result[15] = 1;
    return result;
}

Result<> read_entry(std::string_view key, const toml::node& node, FrameCamera& camera) {
    if (key == "up") {
        const std::optional<std::string> axis = node.value<std::string>();
        if (axis != "y" && axis != "z") return user_error("up: \"y\" or \"z\" is needed");
        camera.is_z_up = axis == "z";
        return {};
    }
    const bool is_matrix = key == "world_to_camera" || key == "camera_to_world" || key == "projection";
    if (!is_matrix && key != "fov")
        return user_error(
            fmt::format("unknown key {}; world_to_camera, camera_to_world, projection, fov and up are known",
                        one_printable_line(key)));
    if (key == "fov") {
        camera.vertical_field_of_view = number(node);
        if (!camera.vertical_field_of_view ||
            !(*camera.vertical_field_of_view > 0 && *camera.vertical_field_of_view < 180))
            return user_error("fov: a number of degrees in (0, 180) is needed");
        return {};
    }
    const auto value = matrix(node);
    if (!value) return user_error(fmt::format("{}: an array of 16 numbers is needed", key));
    DARKROOM_TRY(check_camera_matrix(key, *value));
    if (key == "projection") {
        camera.projection = value;
        return {};
    }
    camera.world_to_camera = key == "world_to_camera" ? value : rigid_inverse(*value);
    if (!camera.world_to_camera)
        return user_error("camera_to_world: a rotation and a translation are needed, unscaled");
    return {};
}

}  // namespace

Result<FrameCamera> read_camera(const std::filesystem::path& path) {
    DARKROOM_TRY_VALUE(auto bytes, read_file(path, {.max_size = max_toml_bytes}));
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    DARKROOM_TRY_VALUE(const toml::table table, parse_toml(text, one_printable_line(path.string())));
    FrameCamera camera;
    for (const auto& [key, node] : table)
        if (auto read = read_entry(key.str(), node, camera); !read)
            return user_error(
                fmt::format("{}:{}: {}", path.string(), node.source().begin.line, std::move(read).error().text));
    return camera;
}

Matrix widened(const Matrix& projection, const PixelWindow& window, std::uint32_t width, std::uint32_t height) {
    const double scale_x = static_cast<double>(window.width) / width;
    const double scale_y = static_cast<double>(window.height) / height;
    const double shift_x = 2.0 * window.x / width + scale_x - 1, shift_y = 2.0 * window.y / height + scale_y - 1;
    Matrix out = projection;
    for (std::size_t column = 0; column < 16; column += 4) {
        out[column] = static_cast<float>(out[column] * scale_x + out[column + 3] * shift_x);
        out[column + 1] = static_cast<float>(out[column + 1] * scale_y + out[column + 3] * shift_y);
    }
    return out;
}

Matrix perspective(double vertical_field_of_view, double aspect) {
    constexpr double near_distance = 0.1;
    constexpr double far_distance = 1000.0;
    const double scale = 1 / std::tan(vertical_field_of_view * std::numbers::pi / 360);
    Matrix matrix{};
    matrix[0] = static_cast<float>(scale / aspect);
    matrix[5] = static_cast<float>(-scale);
    matrix[10] = static_cast<float>(far_distance / (near_distance - far_distance));
    matrix[11] = -1;
    matrix[14] = static_cast<float>(near_distance * far_distance / (near_distance - far_distance));
    return matrix;
}

}  // namespace darkroom
