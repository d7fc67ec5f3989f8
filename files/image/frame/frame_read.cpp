// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "formats/exr/exr_check.hpp"
#include "image/camera/camera_check.hpp"
#include "image/camera/world_space.hpp"
#include "image/color/configuration.hpp"
#include "image/color/convert_picture.hpp"
#include "image/frame/frame_file.hpp"
#include "image/frame/frame_lights.hpp"
#include "image/frame/layer_read.hpp"
#include "image/picture/alpha.hpp"
#include "image/picture/finite.hpp"

namespace darkroom {
namespace {

constexpr std::uint16_t half_one = 0x3c00;

bool is_inside(const FilePart& part, std::uint32_t x, std::uint32_t y) {
    const std::int64_t column = std::int64_t{x} - part.x;
    const std::int64_t row = std::int64_t{y} - part.y;
    return column >= 0 && row >= 0 && column < part.width && row < part.height;
}

// How far away a projection has depth 0, or 1 where depth is reversed.
std::optional<double> near_clip(const Matrix& projection) {
    // Depth is (m - a d) / (e d + b) at the distance d.
    const double a = projection[10], m = projection[14], e = -double{projection[11]}, b = projection[15];
    double near = std::numeric_limits<double>::infinity();
    for (const double depth : {0.0, 1.0}) {
        const double distance = (m - depth * b) / (a + depth * e);
        if (distance > 0) near = std::min(near, distance);
    }
    if (!std::isfinite(near)) return std::nullopt;
    return near;
}

class FrameReader {
  public:
    FrameReader(Decoder& decoder, const FrameOptions& options) : decoder_(decoder), options_(options) {}
    Result<FrameFile> read();

  private:
    Result<> keep_overscan();
    void widen_camera();
    Result<> make_color();
    Result<> make_depth();
    Result<> make_normals();
    Result<> make_velocity();
    Result<> make_masks();
    void finish_color();
    void scale_by_alpha(float (*scale)(float value, float alpha));
    void finish_depth();
    void make_depth_planar();
    void finish_normals();
    void finish_velocity();
    void finish_masks();
    Result<> read_camera_of_file();
    void read_time_of_file();
    [[nodiscard]] bool is_integer() const { return darkroom::is_integer(frame_.samples); }
    [[nodiscard]] ColorCoding coding_of_color();
    void find_conversion();
    [[nodiscard]] bool are_halves(const ChannelSet& set, std::uint32_t components) const;
    void add_place(const ChannelSet& set, std::uint32_t components, std::vector<float>& plane);
    void add_half_place(const ChannelSet& set, std::uint32_t components, std::vector<std::uint16_t>& plane);
    [[nodiscard]] Result<> check(const ChannelSet& set, std::uint32_t components, std::string_view what) const {
        return check_layer(part(set), set, components, what, frame_.color.width, frame_.color.height);
    }
    [[nodiscard]] const FilePart& part(const ChannelSet& set) const { return decoder_.parts()[set.part]; }
    template <std::size_t count>
    [[nodiscard]] std::optional<std::array<float, count>> floats(const char* attribute) const;
    [[nodiscard]] std::optional<Matrix> matrix(const char* attribute) const { return floats<16>(attribute); }
    [[nodiscard]] std::optional<Matrix> world_to_camera() const;

    Decoder& decoder_;
    const FrameOptions& options_;
    FrameChannels found_;
    FrameFile frame_;
    std::vector<LayerPlace> places_;  // of what is read
    bool is_vray_ = false;
    bool has_projection_ = false;           // a matrix, and not a field of view alone
    TransferCurve curve_;                   // of the colour
    std::optional<ColorMatrix> to_rec709_;  // of its light; none: it is that
    std::optional<Matrix> vray_normals_;    // world to camera, of what V-Ray wrote
};

template <std::size_t count>
std::optional<std::array<float, count>> FrameReader::floats(const char* attribute) const {
    const std::vector<float> values = decoder_.numbers(found_.color.part, attribute);
    if (values.size() != count) return std::nullopt;
    std::array<float, count> result{};
    std::copy(values.begin(), values.end(), result.begin());
    return result;
}

// As the file has it. V-Ray has a name of its own.
std::optional<Matrix> FrameReader::world_to_camera() const {
    const std::optional<Matrix> standard = matrix("worldToCamera");
    return standard || !is_vray_ ? standard : matrix("cameraTransform");
}

bool FrameReader::are_halves(const ChannelSet& set, std::uint32_t components) const {
    if (!options_.keeps_halves || &decoder_.format() != &exr_format()) return false;
    for (std::uint32_t i = 0; i < components; ++i)
        if (set.channels[i] >= 0 && part(set).kinds[static_cast<std::size_t>(set.channels[i])] != SampleKind::Half)
            return false;
    return true;
}

void FrameReader::add_place(const ChannelSet& set, std::uint32_t components, std::vector<float>& plane) {
    places_.push_back({.source = set, .components = components, .plane = reinterpret_cast<std::byte*>(plane.data())});
}

void FrameReader::add_half_place(const ChannelSet& set, std::uint32_t components, std::vector<std::uint16_t>& plane) {
    places_.push_back({.source = set,
                       .components = components,
                       .kind = SampleKind::Half,
                       .plane = reinterpret_cast<std::byte*>(plane.data())});
}

// What is asked for goes before what the file says, and that before what is usual.
ColorCoding FrameReader::coding_of_color() {
    if (options_.input_chain) return {.curve = {}};
    if (const std::optional<InputSpace>& space = options_.input_space)
        return {space->primaries, is_integer() ? space->integers : space->floats};
    const FileColor color = decoder_.color(found_.color.part);
    if (!color.warning.empty()) frame_.warnings.push_back(color.warning);
    frame_.color_said = color.said;
    if (color.coding) return *color.coding;
    if (is_integer()) return {};
    const std::string& red = part(found_.color).channels[static_cast<std::size_t>(found_.color.channels[0])];
    if (red.ends_with("X") || red.ends_with("x"))
        frame_.warnings.emplace_back(
            "the color is in X, Y, Z and no chromaticities are given: taken as linear Rec. 709");
    return {.curve = {}};
}

void FrameReader::find_conversion() {
    const ColorCoding coding = coding_of_color();
    curve_ = coding.curve;
    if (found_.is_gray) return;
    to_rec709_ = to_rec709(coding.primaries);
    if (!to_rec709_) frame_.warnings.emplace_back("the chromaticities span no color space: taken as linear Rec. 709");
    // Not even the sign of a zero may change in a picture that is in our primaries.
    if (to_rec709_ == ColorMatrix{1, 0, 0, 0, 1, 0, 0, 0, 1}) to_rec709_.reset();
}

// The display window and the data window of the colour, whichever reaches further on each side.
Result<> FrameReader::keep_overscan() {
    const FilePart& of = part(found_.color);
    const int left = std::min(0, of.x), top = std::min(0, of.y);
    const auto reach = [](std::uint32_t display, int first, std::uint32_t size) {
        return std::max<std::int64_t>(display, std::int64_t{first} + size);
    };
    const std::int64_t width = reach(of.display_width, of.x, of.width) - left;
    const std::int64_t height = reach(of.display_height, of.y, of.height) - top;
    if (width == of.display_width && height == of.display_height) return {};
    const std::int64_t most =
        4 * (std::int64_t{of.display_width} * of.display_height + std::int64_t{of.width} * of.height);
    if (width > max_picture_side || height > max_picture_side || width * height > most)
        return user_error(
            fmt::format("the display window and the data window span {}x{} pixels; {} a side, and four times "
                        "the pixels of both, are allowed",
                        width, height, max_picture_side));
    frame_.display = PixelWindow{-left, -top, of.display_width, of.display_height};
    decoder_.set_display_window({left, top, static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)});
    return {};
}

void FrameReader::widen_camera() {
    if (!frame_.display) return;
    for (std::optional<Matrix>* const projection : {&frame_.camera.projection, &frame_.camera.previous_projection})
        if (*projection) *projection = widened(**projection, *frame_.display, frame_.color.width, frame_.color.height);
    frame_.camera.vertical_field_of_view.reset();
}

Result<> FrameReader::make_color() {
    const FilePart& source = part(found_.color);
    // 2^28 pixels are 4 GiB here, and more than any device takes as one image.
    if (std::uint64_t{source.display_width} * source.display_height > (std::uint64_t{1} << 28))
        return user_error(fmt::format("the picture is {}x{}, at most {} pixels are allowed", source.display_width,
                                      source.display_height, 1u << 28));
    frame_.color.width = source.display_width;
    frame_.color.height = source.display_height;
    const std::size_t pixels = std::size_t{source.display_width} * source.display_height;
    DARKROOM_TRY(check(found_.color, 4, "the color"));
    frame_.samples = source.kinds[static_cast<std::size_t>(found_.color.channels[0])];
    frame_.has_alpha = found_.color.channels[3] >= 0;
    frame_.is_associated = frame_.has_alpha && source.is_associated && !is_integer();
    find_conversion();
    const auto fill_alpha = [&](auto& values, auto one) {
        for (std::size_t i = 0; i < pixels; ++i)
            if (is_inside(source, static_cast<std::uint32_t>(i % source.display_width),
                          static_cast<std::uint32_t>(i / source.display_width)))
                values[i * 4 + 3] = one;
    };
    if (!to_rec709_ && curve_.is_linear() && !options_.input_chain && are_halves(found_.color, 4)) {
        frame_.halves.color.resize(pixels * 4);
        if (!frame_.has_alpha) fill_alpha(frame_.halves.color, half_one);
        add_half_place(found_.color, 4, frame_.halves.color);
        return {};
    }
    frame_.color.pixels.resize(pixels * 4);
    if (!frame_.has_alpha) fill_alpha(frame_.color.pixels, 1.0f);
    add_place(found_.color, 4, frame_.color.pixels);
    return {};
}

void FrameReader::finish_color() {
    if (!frame_.halves.color.empty()) {
        make_finite(frame_.halves.color, frame_.counts);
        return;
    }
    make_finite(frame_.color, frame_.counts);
    // Curves are of straight colour. Floats stay associated, and what shines without covering has no alpha to divide
    // by.
    const bool has_curve = options_.input_chain != nullptr || !curve_.is_linear();
    if (frame_.has_alpha && part(found_.color).is_associated && is_integer()) make_straight(frame_.color.pixels);
    if (frame_.is_associated && has_curve) scale_by_alpha([](float value, float alpha) { return value / alpha; });
    if (options_.input_chain)
        apply(*options_.input_chain, frame_.color);
    else
        decode(frame_.color, frame_.samples, curve_);
    if (frame_.is_associated && has_curve) scale_by_alpha([](float value, float alpha) { return value * alpha; });
    if (to_rec709_) convert(frame_.color, *to_rec709_);
}

void FrameReader::scale_by_alpha(float (*scale)(float value, float alpha)) {
    std::vector<float>& rgba = frame_.color.pixels;
    for (std::size_t i = 0; i < rgba.size(); ++i)
        if (i % 4 != 3 && rgba[i | 3] > 0) rgba[i] = scale(rgba[i], rgba[i | 3]);
}

Result<> FrameReader::make_depth() {
    if (!found_.depth || !options_.has_depth) return {};
    DARKROOM_TRY(check(*found_.depth, 1, "the depth"));
    frame_.depth.emplace(frame_.color.width, frame_.color.height);
    std::fill(frame_.depth->values.begin(), frame_.depth->values.end(), sky_depth);
    add_place(*found_.depth, 1, frame_.depth->values);
    return {};
}

// Turns what the file has into metres along the view axis. Where the numbers are places on an axis that points at the
// viewer, all are negative.
void FrameReader::finish_depth() {
    if (!frame_.depth) return;
    std::vector<float>& values = frame_.depth->values;
    const auto scale = static_cast<float>(options_.depth_scale.value_or(found_.depth_scale));
    std::size_t zeros = 0;
    bool has_negative = false, has_positive = false;
    for (float& value : values) {
        if (!std::isfinite(value) || value >= 1e9f) continue;
        zeros += value == 0 && !found_.is_depth_along_ray;
        has_negative |= value < 0;
        has_positive |= value > 0;
        if (found_.is_depth_along_ray && value == 0) value = sky_depth;
        if (options_.is_depth_inverse) value = value == 0 ? sky_depth : 1 / value;
        if (value < 1e9f) value *= scale;
    }
    if (has_negative && !has_positive)
        for (float& value : values)
            if (value < 0 && std::isfinite(value)) value = -value;
    if (zeros > 0 && !options_.is_depth_inverse)
        frame_.warnings.push_back(
            fmt::format("depth is 0 in {:.3g} % of the pixels, and is taken as a surface at the camera{}",
                        100.0 * static_cast<double>(zeros) / static_cast<double>(values.size()),
                        decoder_.has_attribute_starting(found_.color.part, "nuke/")
                            ? ": Nuke wrote it; where it is 1 / distance, --depth-inverse says so"
                            : "; some renderers write it where nothing is"));
    for (float& distance : values) {
        if (distance < 1e9f && std::isfinite(distance)) continue;
        frame_.counts.not_finite_other += std::isnan(distance) || distance == -std::numeric_limits<float>::infinity();
        distance = sky_depth;
    }
}

// The length of a ray from the near clip on to the distance along the view axis, which the camera tells.
void FrameReader::make_depth_planar() {
    if (!frame_.depth || !found_.is_depth_along_ray) return;
    const std::optional<Matrix>& projection = frame_.camera.projection;
    if (!projection || (*projection)[0] == 0 || (*projection)[5] == 0) {
        frame_.warnings.push_back(
            fmt::format("{}.T is the length of a ray, and no camera is known that makes it depth: "
                        "left out; --fov or --camera tells one",
                        one_printable_line(found_.depth->prefix)));
        frame_.depth.reset();
        return;
    }
    const Matrix& p = *projection;
    constexpr double of_mitsuba = 0.01;  // in the file's unit, unless a scene says another
    const double near =
        (has_projection_ ? near_clip(p) : std::nullopt).value_or(of_mitsuba * options_.depth_scale.value_or(1));
    const bool is_parallel = p[11] == 0;
    const std::uint32_t width = frame_.color.width, height = frame_.color.height;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            float& value = frame_.depth->values[std::size_t{y} * width + x];
            if (value >= 1e9F) continue;
            const double right = is_parallel ? 0 : ((2 * x + 1.0) / width - 1 + double{p[8]}) / double{p[0]};
            const double up = is_parallel ? 0 : ((2 * y + 1.0) / height - 1 + double{p[9]}) / double{p[5]};
            value = static_cast<float>(near + value / std::sqrt(1 + right * right + up * up));
        }
}

// V-Ray writes normals in the space of its camera (x right, y down, z forward), others in that of the world.
Result<> FrameReader::make_normals() {
    if (!found_.normals || !options_.has_normals) return {};
    DARKROOM_TRY(check(*found_.normals, 3, "the normals"));
    if (is_vray_ && !options_.names.contains("normals") && !options_.normals_space) {
        vray_normals_ = world_to_camera();
        if (!vray_normals_ || !check_camera_matrix("", *vray_normals_)) {
            frame_.warnings.emplace_back(
                "V-Ray normals without cameraTransform cannot be turned to world space: left out");
            return {};
        }
    }
    frame_.normals.emplace();
    frame_.normals->width = frame_.color.width;
    frame_.normals->height = frame_.color.height;
    const std::size_t pixels = std::size_t{frame_.color.width} * frame_.color.height;
    if (!vray_normals_ && are_halves(*found_.normals, 3)) {
        frame_.halves.normals.resize(pixels * 4);
        for (std::size_t i = 3; i < pixels * 4; i += 4) frame_.halves.normals[i] = half_one;
        add_half_place(*found_.normals, 4, frame_.halves.normals);
        places_.back().read = 3;
        return {};
    }
    frame_.normals->values.resize(pixels * 3);
    add_place(*found_.normals, 3, frame_.normals->values);
    return {};
}

void FrameReader::finish_normals() {
    std::vector<std::uint16_t>& halves = frame_.halves.normals;
    for (std::size_t i = 0; i < halves.size(); i += 4) {
        if (is_finite_half(halves[i]) && is_finite_half(halves[i + 1]) && is_finite_half(halves[i + 2])) continue;
        ++frame_.counts.not_finite_other;
        std::fill_n(&halves[i], 3, std::uint16_t{0});
    }
    if (!frame_.normals) return;
    for (std::size_t i = 0; i < frame_.normals->values.size(); i += 3) {
        float* normal = &frame_.normals->values[i];
        if (!std::isfinite(normal[0]) || !std::isfinite(normal[1]) || !std::isfinite(normal[2])) {
            ++frame_.counts.not_finite_other;
            std::fill_n(normal, 3, 0.0f);
        }
        if (!vray_normals_) continue;
        const Matrix& turn = *vray_normals_;
        const std::array<float, 3> in{normal[0], normal[1], normal[2]};
        for (std::size_t row = 0; row < 3; ++row)
            normal[row] = turn[row * 4] * in[0] + turn[row * 4 + 1] * in[1] + turn[row * 4 + 2] * in[2];
    }
}

Result<> FrameReader::make_velocity() {
    if (!found_.velocity || !options_.has_velocity) return {};
    DARKROOM_TRY(check(*found_.velocity, 2, "the motion"));
    frame_.velocity.emplace();
    frame_.velocity->width = frame_.color.width;
    frame_.velocity->height = frame_.color.height;
    const std::size_t values = std::size_t{frame_.color.width} * frame_.color.height * 2;
    if (!found_.is_velocity_y_up && are_halves(*found_.velocity, 2)) {
        frame_.halves.velocity.resize(values);
        add_half_place(*found_.velocity, 2, frame_.halves.velocity);
        return {};
    }
    frame_.velocity->values.resize(values);
    add_place(*found_.velocity, 2, frame_.velocity->values);
    return {};
}

void FrameReader::finish_velocity() {
    std::vector<std::uint16_t>& halves = frame_.halves.velocity;
    for (std::size_t i = 0; i < halves.size(); i += 2) {
        if (is_finite_half(halves[i]) && is_finite_half(halves[i + 1])) continue;
        ++frame_.counts.not_finite_other;
        halves[i] = halves[i + 1] = 0;
    }
    if (!frame_.velocity) return;
    for (std::size_t i = 0; i < frame_.velocity->values.size(); i += 2) {
        float* motion = &frame_.velocity->values[i];
        if (!std::isfinite(motion[0]) || !std::isfinite(motion[1])) {
            ++frame_.counts.not_finite_other;
            std::fill_n(motion, 2, 0.0f);
        }
        if (found_.is_velocity_y_up) motion[1] = -motion[1];
    }
}

Result<> FrameReader::make_masks() {
    const auto make = [&](const auto& found, std::uint32_t components, std::string_view what, auto& plane) -> Result<> {
        DARKROOM_TRY(check(*found, components, what));
        plane.emplace(frame_.color.width, frame_.color.height);
        add_place(*found, components, plane->values);
        return {};
    };
    if (found_.reactive && options_.has_reactive)
        DARKROOM_TRY(make(found_.reactive, 1, "the reactive mask", frame_.reactive));
    // If colours are converted into ours, the space of this layer is not known.
    if (!found_.transparency || !options_.has_transparency || to_rec709_ || options_.input_chain) return {};
    return make(found_.transparency, 3, "the colour before transparency", frame_.transparency);
}

void FrameReader::finish_masks() {
    for (std::vector<float>* const values : {frame_.reactive ? &frame_.reactive->values : nullptr,
                                             frame_.transparency ? &frame_.transparency->values : nullptr})
        if (values != nullptr)
            for (float& value : *values) {
                if (std::isfinite(value)) continue;
                ++frame_.counts.not_finite_other;
                value = 0;
            }
}

Result<> FrameReader::read_camera_of_file() {
    FrameCamera& camera = frame_.camera;
    const PixelWindow seen = frame_.display.value_or(PixelWindow{0, 0, frame_.color.width, frame_.color.height});
    const double aspect = static_cast<double>(seen.width) / seen.height;
    camera.world_to_camera = world_to_camera();
    camera.projection = matrix("darkroom:projection");
    camera.previous_world_to_camera = matrix("darkroom:previousWorldToCamera");
    camera.previous_projection = matrix("darkroom:previousProjection");
    camera.jitter = floats<2>("darkroom:jitter");
    camera.previous_jitter = floats<2>("darkroom:previousJitter");
    const auto distance = [&](const char* name) -> std::optional<float> {
        const std::optional<double> value = decoder_.number(found_.color.part, name);
        if (!value || !(*value >= 0)) return std::nullopt;
        return static_cast<float>(*value);
    };
    camera.near_distance = distance("darkroom:near");
    camera.far_distance = distance("darkroom:far");
    // What follows from another camera than the file's is known of the file's alone.
    const auto forget = [&] {
        camera = {.world_to_camera = camera.world_to_camera,
                  .projection = camera.projection,
                  .vertical_field_of_view = camera.vertical_field_of_view,
                  .is_z_up = camera.is_z_up};
    };
    if (is_vray_) {
        if (camera.world_to_camera)
            for (std::size_t i = 0; i < 16; ++i)
                if (i % 4 == 1 || i % 4 == 2) (*camera.world_to_camera)[i] = -(*camera.world_to_camera)[i];
        const std::vector<float> fov = decoder_.numbers(found_.color.part, "cameraFov");  // horizontal
        if (!camera.projection && fov.size() == 1 && fov[0] > 0 && fov[0] < 180) {
            constexpr double degrees = 180 / std::numbers::pi;
            camera.vertical_field_of_view = 2 * degrees * std::atan(std::tan(fov[0] / degrees / 2) / aspect);
        }
    }
    if (!options_.camera_file.empty()) {
        DARKROOM_TRY_VALUE(auto given, read_camera(options_.camera_file));
        forget();
        if (given.world_to_camera) camera.world_to_camera = given.world_to_camera;
        camera.is_z_up = given.is_z_up;
        if (given.projection || given.vertical_field_of_view) {
            camera.projection = given.projection;
            camera.vertical_field_of_view = given.vertical_field_of_view;
        }
    }
    if (options_.vertical_field_of_view) {
        if (!(*options_.vertical_field_of_view > 0 && *options_.vertical_field_of_view < 180))
            return user_error(
                fmt::format("a field of view of {} degrees; (0, 180) is allowed", *options_.vertical_field_of_view));
        forget();
        camera.projection.reset();
        camera.vertical_field_of_view = options_.vertical_field_of_view;
    }
    has_projection_ = camera.projection.has_value();
    if (!has_projection_ && camera.vertical_field_of_view)
        camera.projection = perspective(*camera.vertical_field_of_view, aspect);
    widen_camera();
    // What a flag has replaced may have been anything.
    return check_camera(camera);
}

void FrameReader::read_time_of_file() {
    const auto number = [&](const char* name) -> std::optional<double> {
        const std::optional<double> value = decoder_.number(found_.color.part, name);
        return value && std::isfinite(*value) ? value : std::nullopt;
    };
    frame_.time = number("darkroom:time");
    frame_.delta_time = number("darkroom:deltaTime");
    if (const auto exposure = number("darkroom:exposure"); exposure && *exposure > 0)
        frame_.exposure = static_cast<float>(*exposure);
    constexpr double most = 9007199254740992;  // 2^53: whole numbers beyond are not exact in a double
    const std::optional<double> index = number("darkroom:frameIndex");
    if (index && *index >= 0 && *index <= most && *index == std::floor(*index))
        frame_.frame_index = static_cast<std::uint64_t>(*index);
}

Result<FrameFile> FrameReader::read() {
    frame_.channels = channel_names(decoder_.parts());
    if (std::string text = decoder_.left_out(); !text.empty()) frame_.warnings.push_back(std::move(text));
    DARKROOM_TRY_VALUE(found_, find_channels(decoder_.parts(), options_.names, options_.view));
    if (options_.view.empty() && found_.views.size() > 1)
        frame_.warnings.push_back(fmt::format("has the views {}: {} is developed, --eye says which",
                                              fmt::join(found_.views, ", "), found_.view));
    if (!found_.other_colors.empty())
        frame_.warnings.push_back(
            fmt::format("the color is {}, although {} might be it as well; --map color=NAME says which",
                        !found_.color.prefix.empty() ? one_printable_line(found_.color.prefix)
                        : found_.is_gray             ? "Y"
                                                     : "R, G, B",
                        one_printable_line(fmt::format("{}", fmt::join(found_.other_colors, ", ")))));
    std::ranges::copy(found_.left_out, std::back_inserter(frame_.warnings));
    is_vray_ = decoder_.has_attribute_starting(found_.color.part, "vrayInfo/");
    frame_.attributes = decoder_.attributes(found_.color.part, ExrAttributes::Of::Picture);
    if (options_.keeps_overscan) DARKROOM_TRY(keep_overscan());
    DARKROOM_TRY(make_color());
    DARKROOM_TRY(make_depth());
    DARKROOM_TRY(make_normals());
    DARKROOM_TRY(make_velocity());
    DARKROOM_TRY(make_masks());
    DARKROOM_TRY(read_layers(decoder_, places_));
    finish_color();
    finish_depth();
    finish_normals();
    finish_velocity();
    finish_masks();
    DARKROOM_TRY(read_camera_of_file());
    make_depth_planar();
    settle_world(frame_, options_, vray_normals_.has_value());
    read_time_of_file();
    DARKROOM_TRY(read_lights(decoder_, found_.color.part, options_, frame_));
    const std::vector<float> aspect = decoder_.numbers(found_.color.part, "PixelAspectRatio");
    if (aspect.size() == 1 && std::abs(aspect[0] - 1) > 1e-3f)
        frame_.warnings.push_back(fmt::format("pixels are {:g} times as wide as high: taken as square", aspect[0]));
    const PixelCounts& counts = frame_.counts;
    if (counts != PixelCounts{})
        frame_.warnings.push_back(fmt::format(
            "pixels that are not finite: NaN {} color, {} alpha; infinite {} color, {} alpha; {} in other channels: "
            "NaN "
            "became 0, infinity +-65504, alpha 1",
            counts.nan_color, counts.nan_alpha, counts.infinite_color, counts.infinite_alpha, counts.not_finite_other));
    return std::move(frame_);
}

}  // namespace

Result<FrameFile> read_frame(const std::filesystem::path& path, const FrameOptions& options) {
    DARKROOM_TRY_VALUE(auto decoder, Decoder::open(path, options.max_threads, DecodingPlace::FramesHere));
    auto frame = FrameReader(decoder, options).read();
    const std::string place = path.string() + ": ";
    if (!frame && !frame.error().text.starts_with(place) &&
        (options.camera_file.empty() || !frame.error().text.starts_with(options.camera_file.string())))
        frame.error().text.insert(0, place);
    return frame;
}

}  // namespace darkroom
