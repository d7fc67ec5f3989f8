// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "image/frame_file.hpp"
#include "image/frame_lights.hpp"
#include "image/primaries.hpp"

namespace darkroom {
namespace {

constexpr float largest_half = 65504.0f;

// Where a channel of the file goes: `value(pixel, component)` of a plane as large as the display window.
struct Destination {
    ChannelSet source;
    std::uint32_t component_count = 0;
    float* values = nullptr;
    std::uint32_t stride = 0;  // floats from one pixel to the next
};

// Copies the channels of one set into place: the data window into the display window, what is outside of it cropped.
Result<> read_set(Decoder& decoder, const Destination& to) {
    const FilePart& part = decoder.parts()[to.source.part];
    int first = std::numeric_limits<int>::max();
    int last = -1;
    for (std::uint32_t i = 0; i < to.component_count; ++i) {
        if (to.source.channels[i] < 0) continue;
        first = std::min(first, to.source.channels[i]);
        last = std::max(last, to.source.channels[i]);
    }
    const auto count = static_cast<std::uint32_t>(last - first + 1);
    const std::int64_t left = std::max<std::int64_t>(0, -std::int64_t{part.x});
    const std::int64_t right = std::min<std::int64_t>(part.width, std::int64_t{part.display_width} - part.x);
    return decoder.read(to.source.part, static_cast<std::uint32_t>(first), count,
                        [&](std::uint32_t row, std::uint32_t rows, std::span<const float> samples) {
                            for (std::uint32_t i = 0; i < rows; ++i) {
                                const std::int64_t y = std::int64_t{row} + i + part.y;
                                if (y < 0 || y >= part.display_height) continue;
                                const float* in = &samples[std::size_t{i} * part.width * count];
                                float* out = to.values + static_cast<std::size_t>(y) * part.display_width * to.stride;
                                for (std::int64_t x = left; x < right; ++x)
                                    for (std::uint32_t c = 0; c < to.component_count; ++c)
                                        if (to.source.channels[c] >= 0)
                                            out[(x + part.x) * to.stride + c] =
                                                in[x * count + (to.source.channels[c] - first)];
                            }
                        });
}

bool is_inside(const FilePart& part, std::uint32_t x, std::uint32_t y) {
    const std::int64_t column = std::int64_t{x} - part.x;
    const std::int64_t row = std::int64_t{y} - part.y;
    return column >= 0 && row >= 0 && column < part.width && row < part.height;
}

void make_finite(Picture& color, PixelCounts& counts) {
    for (std::size_t i = 0; i < color.pixels.size(); i += 4) {
        float* pixel = &color.pixels[i];
        bool has_nan = false;
        bool has_infinity = false;
        for (int c = 0; c < 3; ++c) {
            if (std::isfinite(pixel[c])) continue;
            has_nan |= std::isnan(pixel[c]);
            has_infinity |= std::isinf(pixel[c]);
            pixel[c] = std::isnan(pixel[c]) ? 0.0f : std::copysign(largest_half, pixel[c]);
        }
        counts.nan_color += has_nan;
        counts.infinite_color += has_infinity;
        if (std::isfinite(pixel[3])) continue;
        ++(std::isnan(pixel[3]) ? counts.nan_alpha : counts.infinite_alpha);
        pixel[3] = 1.0f;
    }
}

// Every code of an 8- or 16-bit file decoded once; a picture has more pixels than there are codes.
void decode_srgb(Picture& color, SampleKind samples) {
    const float largest = samples == SampleKind::Integer8 ? 255.0f : 65535.0f;
    std::vector<float> decoded(static_cast<std::size_t>(largest) + 1);
    for (std::size_t code = 0; code < decoded.size(); ++code)
        decoded[code] = srgb_decode(static_cast<float>(code) / largest);
    for (std::size_t i = 0; i < color.pixels.size(); ++i)
        if (i % 4 != 3) color.pixels[i] = decoded[static_cast<std::size_t>(std::lround(color.pixels[i] * largest))];
}

void convert(Picture& color, const ColorMatrix& matrix) {
    // Not even the sign of a zero may change in a picture that is in our primaries.
    if (matrix == ColorMatrix{1, 0, 0, 0, 1, 0, 0, 0, 1}) return;
    constexpr double largest = std::numeric_limits<float>::max();
    for (std::size_t i = 0; i < color.pixels.size(); i += 4) {
        float* pixel = &color.pixels[i];
        const std::array<double, 3> in{pixel[0], pixel[1], pixel[2]};
        for (std::size_t c = 0; c < 3; ++c) {
            const double value = matrix[c * 3] * in[0] + matrix[c * 3 + 1] * in[1] + matrix[c * 3 + 2] * in[2];
            pixel[c] = static_cast<float>(std::clamp(value, -largest, largest));
        }
    }
}

class FrameReader {
  public:
    FrameReader(Decoder& decoder, const FrameOptions& options) : decoder_(decoder), options_(options) {}
    Result<FrameFile> read();

  private:
    Result<> read_color();
    Result<> read_depth();
    Result<> read_normals();
    Result<> read_velocity();
    Result<> read_camera_of_file();
    void read_time_of_file();
    void convert_color();
    [[nodiscard]] Result<> check(const ChannelSet& set, std::uint32_t components, const char* what) const;
    [[nodiscard]] const FilePart& part(const ChannelSet& set) const { return decoder_.parts()[set.part]; }

    Decoder& decoder_;
    const FrameOptions& options_;
    FrameChannels found_;
    FrameFile frame_;
    bool is_vray_ = false;
};

// All parts of an OpenEXR file should have one display window; a plane of another size than the picture has no meaning.
Result<> FrameReader::check(const ChannelSet& set, std::uint32_t components, const char* what) const {
    const FilePart& ours = part(set);
    if (ours.display_width != frame_.color.width || ours.display_height != frame_.color.height)
        return user_error(fmt::format("{} is {}x{}, the color is {}x{}; one display window is needed", what,
                                      ours.display_width, ours.display_height, frame_.color.width,
                                      frame_.color.height));
    for (std::uint32_t i = 0; i < components; ++i) {
        if (set.channels[i] < 0) continue;
        const auto channel = static_cast<std::size_t>(set.channels[i]);
        if (ours.kinds[channel] == SampleKind::Integer32)
            return user_error(fmt::format("channel {} for {} has 32-bit integers; half or float is needed",
                                          one_printable_line(ours.channels[channel]), what));
    }
    return {};
}

Result<> FrameReader::read_color() {
    const FilePart& source = part(found_.color);
    // 2^28 pixels are 4 GiB here, and more than any device takes as one image.
    if (std::uint64_t{source.display_width} * source.display_height > (std::uint64_t{1} << 28))
        return user_error(fmt::format("the picture is {}x{}, at most {} pixels are allowed", source.display_width,
                                      source.display_height, 1u << 28));
    frame_.color = Picture(source.display_width, source.display_height);
    if (auto checked = check(found_.color, 4, "the color"); !checked) return checked;
    frame_.samples = source.kinds[static_cast<std::size_t>(found_.color.channels[0])];
    frame_.has_alpha = found_.color.channels[3] >= 0;
    if (!frame_.has_alpha)
        for (std::uint32_t y = 0; y < frame_.color.height; ++y)
            for (std::uint32_t x = 0; x < frame_.color.width; ++x)
                frame_.color.at(x, y)[3] = is_inside(source, x, y) ? 1.0f : 0.0f;
    if (auto read = read_set(decoder_, {found_.color, 4, frame_.color.pixels.data(), 4}); !read) return read;
    convert_color();
    return {};
}

void FrameReader::convert_color() {
    make_finite(frame_.color, frame_.counts);
    if (frame_.samples == SampleKind::Integer8 || frame_.samples == SampleKind::Integer16) {
        decode_srgb(frame_.color, frame_.samples);
        return;
    }
    const std::vector<float> values = decoder_.numbers(found_.color.part, "chromaticities");
    if (values.size() != 8) {
        const std::string& red = part(found_.color).channels[static_cast<std::size_t>(found_.color.channels[0])];
        if (red.ends_with("X") || red.ends_with("x"))
            frame_.warnings.push_back(
                "the color is in X, Y, Z and no chromaticities are given: taken as linear Rec. 709");
        return;
    }
    if (found_.is_gray) return;
    const Chromaticities primaries{.red = {values[0], values[1]},
                                   .green = {values[2], values[3]},
                                   .blue = {values[4], values[5]},
                                   .white = {values[6], values[7]}};
    if (const auto matrix = to_rec709(primaries))
        convert(frame_.color, *matrix);
    else
        frame_.warnings.push_back("the chromaticities span no color space: taken as linear Rec. 709");
}

Result<> FrameReader::read_depth() {
    if (!found_.depth) return {};
    if (auto checked = check(*found_.depth, 1, "the depth"); !checked) return checked;
    Plane<1> depth(frame_.color.width, frame_.color.height);
    std::fill(depth.values.begin(), depth.values.end(), sky_depth);
    if (auto read = read_set(decoder_, {*found_.depth, 1, depth.values.data(), 1}); !read) return read;
    for (float& distance : depth.values) {
        frame_.counts.not_finite_other += std::isnan(distance) || distance == -std::numeric_limits<float>::infinity();
        if (!(distance < 1e9f) || std::isinf(distance)) distance = sky_depth;
    }
    frame_.depth = std::move(depth);
    return {};
}

// V-Ray writes normals in the space of its camera (x right, y down, z forward), others in that of the world.
Result<> FrameReader::read_normals() {
    if (!found_.normals) return {};
    if (auto checked = check(*found_.normals, 3, "the normals"); !checked) return checked;
    Plane<3> normals(frame_.color.width, frame_.color.height);
    if (auto read = read_set(decoder_, {*found_.normals, 3, normals.values.data(), 3}); !read) return read;
    const bool is_in_camera_space = is_vray_ && !options_.names.contains("normals");
    const std::vector<float> vray = decoder_.numbers(found_.color.part, "worldtocamera");
    if (is_in_camera_space && vray.size() != 16) {
        frame_.warnings.push_back("V-Ray normals without worldToCamera cannot be turned to world space: left out");
        return {};
    }
    for (std::size_t i = 0; i < normals.values.size(); i += 3) {
        float* normal = &normals.values[i];
        if (!std::isfinite(normal[0]) || !std::isfinite(normal[1]) || !std::isfinite(normal[2])) {
            ++frame_.counts.not_finite_other;
            std::fill_n(normal, 3, 0.0f);
        }
        if (!is_in_camera_space) continue;
        const std::array<float, 3> in{normal[0], normal[1], normal[2]};
        for (std::size_t row = 0; row < 3; ++row)
            normal[row] = vray[row * 4] * in[0] + vray[row * 4 + 1] * in[1] + vray[row * 4 + 2] * in[2];
    }
    frame_.normals = std::move(normals);
    return {};
}

Result<> FrameReader::read_velocity() {
    if (!found_.velocity) return {};
    if (auto checked = check(*found_.velocity, 2, "the motion"); !checked) return checked;
    Plane<2> velocity(frame_.color.width, frame_.color.height);
    if (auto read = read_set(decoder_, {*found_.velocity, 2, velocity.values.data(), 2}); !read) return read;
    for (std::size_t i = 0; i < velocity.values.size(); i += 2) {
        float* motion = &velocity.values[i];
        if (!std::isfinite(motion[0]) || !std::isfinite(motion[1])) {
            ++frame_.counts.not_finite_other;
            std::fill_n(motion, 2, 0.0f);
        }
        if (found_.is_velocity_y_up) motion[1] = -motion[1];
    }
    frame_.velocity = std::move(velocity);
    return {};
}

Result<> FrameReader::read_camera_of_file() {
    FrameCamera& camera = frame_.camera;
    const auto matrix = [&](const char* name) -> std::optional<Matrix> {
        const std::vector<float> values = decoder_.numbers(found_.color.part, name);
        if (values.size() != 16 || !std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); }))
            return std::nullopt;
        Matrix result{};
        std::copy(values.begin(), values.end(), result.begin());
        return result;
    };
    const double aspect = static_cast<double>(frame_.color.width) / frame_.color.height;
    camera.world_to_camera = matrix("worldtocamera");
    camera.projection = matrix("darkroom:projection");
    camera.previous_world_to_camera = matrix("darkroom:previousWorldToCamera");
    camera.previous_projection = matrix("darkroom:previousProjection");
    const auto distance = [&](const char* name) -> std::optional<float> {
        const std::optional<double> value = decoder_.number(found_.color.part, name);
        if (!value || !(*value >= 0)) return std::nullopt;
        return static_cast<float>(*value);
    };
    camera.near_distance = distance("darkroom:near");
    camera.far_distance = distance("darkroom:far");
    // What follows from another camera than the file's is known of the file's alone.
    const auto forget = [&] {
        camera.previous_world_to_camera.reset();
        camera.previous_projection.reset();
        camera.near_distance.reset();
        camera.far_distance.reset();
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
        auto given = read_camera(options_.camera_file);
        if (!given) return failure(std::move(given));
        forget();
        if (given->world_to_camera) camera.world_to_camera = given->world_to_camera;
        if (given->projection || given->vertical_field_of_view) {
            camera.projection = given->projection;
            camera.vertical_field_of_view = given->vertical_field_of_view;
        }
    }
    if (options_.vertical_field_of_view) {
        if (!(*options_.vertical_field_of_view > 0 && *options_.vertical_field_of_view < 180))
            return user_error(fmt::format("a field of view of {} degrees; more than 0 and less than 180 is allowed",
                                          *options_.vertical_field_of_view));
        forget();
        camera.projection.reset();
        camera.vertical_field_of_view = options_.vertical_field_of_view;
    }
    if (!camera.projection && camera.vertical_field_of_view)
        camera.projection = perspective(*camera.vertical_field_of_view, aspect);
    return {};
}

void FrameReader::read_time_of_file() {
    const auto number = [&](const char* name) -> std::optional<double> {
        const std::optional<double> value = decoder_.number(found_.color.part, name);
        return value && std::isfinite(*value) ? value : std::nullopt;
    };
    frame_.time = number("darkroom:time");
    frame_.delta_time = number("darkroom:deltaTime");
    constexpr double most = 9007199254740992;  // 2^53: whole numbers beyond are not exact in a double
    const std::optional<double> index = number("darkroom:frameIndex");
    if (index && *index >= 0 && *index <= most && *index == std::floor(*index))
        frame_.frame_index = static_cast<std::uint64_t>(*index);
}

Result<FrameFile> FrameReader::read() {
    frame_.kind = decoder_.kind();
    frame_.channels = channel_names(decoder_.parts());
    auto found = find_channels(decoder_.parts(), options_.names);
    if (!found) return failure(std::move(found));
    found_ = std::move(*found);
    is_vray_ = decoder_.has_attribute_starting(found_.color.part, "vrayInfo/");
    if (auto done = read_color(); !done) return failure(std::move(done));
    if (auto done = read_depth(); !done) return failure(std::move(done));
    if (auto done = read_normals(); !done) return failure(std::move(done));
    if (auto done = read_velocity(); !done) return failure(std::move(done));
    if (auto done = read_camera_of_file(); !done) return failure(std::move(done));
    read_time_of_file();
    if (auto done = read_lights(decoder_, found_.color.part, options_, frame_); !done) return failure(std::move(done));
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
    auto decoder = Decoder::open(path);
    if (!decoder) return failure(std::move(decoder));
    auto frame = FrameReader(*decoder, options).read();
    const std::string place = path.string() + ": ";
    if (!frame && !frame.error().text.starts_with(place) &&
        (options.camera_file.empty() || !frame.error().text.starts_with(options.camera_file.string())))
        frame.error().text.insert(0, place);
    return frame;
}

Result<> add_mapping(LayerNames& names, std::string_view mapping) {
    const std::size_t equals = mapping.find('=');
    const std::string what(mapping.substr(0, equals));
    const bool is_known = what == "color" || what == "depth" || what == "normals" || what == "velocity";
    if (equals == std::string_view::npos || equals + 1 == mapping.size() || !is_known)
        return user_error(fmt::format(
            "\"{}\" maps nothing; color, depth, normals or velocity, then = and the name of a channel are needed",
            one_printable_line(mapping)));
    names[what] = mapping.substr(equals + 1);
    return {};
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
