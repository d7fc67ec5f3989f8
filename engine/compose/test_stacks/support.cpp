// SPDX-License-Identifier: MIT
#include "compose/test_stacks/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "compose/test_stacks/shadow_map.hpp"
#include "gpu/test_run.hpp"

namespace darkroom::test {

namespace {

/// PCG hash (Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020): the same bits everywhere.
std::uint32_t hash(std::uint32_t value) {
    const std::uint32_t state = value * 747796405u + 2891336453u;
    const std::uint32_t word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}
double unit(std::uint32_t value) { return hash(value) / 4294967296.0; }

template <class Function>
ReferenceImage filled(std::uint32_t width, std::uint32_t height, const Function& value) {
    ReferenceImage out(width, height);
    std::uint32_t i = 0;
    for (Rgba& pixel : out.pixels) {
        pixel = {value(i), value(i + 1), value(i + 2), 1};
        i += 3;
    }
    return out;
}

double half_of(double value) {
    if (!std::isfinite(value) || value == 0) return value;
    const int exponent = std::max(std::ilogb(value), -14);
    const double step = std::ldexp(1.0, exponent - 10);
    const double rounded = std::nearbyint(value / step) * step;
    return std::abs(rounded) > 65504 ? std::copysign(std::numeric_limits<double>::infinity(), value) : rounded;
}

template <class Function>
ReferenceImage mapped(const ReferenceImage& image, const Function& function) {
    ReferenceImage out = image;
    for (Rgba& p : out.pixels) p = {function(p.r), function(p.g), function(p.b), function(p.a)};
    return out;
}

gpu::test::Pixels to_pixels(const ReferenceImage& image) {
    return gpu::test::make_pixels(image.width, image.height, [&](std::uint32_t x, std::uint32_t y) {
        const Rgba& p = image.at(x, y);
        return std::array{static_cast<float>(p.r), static_cast<float>(p.g), static_cast<float>(p.b),
                          static_cast<float>(p.a)};
    });
}

ImageRef image_ref(const gpu::test::Picture& picture) {
    return {.image = picture.image.handle,
            .view = picture.image.mip_views[0],
            .format = picture.image.info.format,
            .extent = {picture.image.info.extent.width, picture.image.info.extent.height},
            .layout = picture.layout,
            .final_layout = picture.layout};
}

}  // namespace

Camera look_at(const std::array<double, 3>& eye, const std::array<double, 3>& target, double field_of_view_rad,
               double aspect) {
    using Vector = std::array<double, 3>;
    const auto normalized = [](Vector v) {
        const double length = std::hypot(v[0], v[1], v[2]);
        return Vector{v[0] / length, v[1] / length, v[2] / length};
    };
    const auto cross = [](const Vector& a, const Vector& b) {
        return Vector{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    const Vector back = normalized({eye[0] - target[0], eye[1] - target[1], eye[2] - target[2]});
    const Vector right = normalized(cross({0, 1, 0}, back)), up = cross(back, right);
    Camera camera{.depth = DepthKind::Planar};
    std::size_t row = 0;
    for (const Vector& axis : {right, up, back}) {
        double along = 0;
        for (std::size_t column = 0; column < 3; ++column) {
            camera.view[column * 4 + row] = static_cast<float>(axis[column]);
            along -= axis[column] * eye[column];
        }
        camera.view[12 + row++] = static_cast<float>(along);
    }
    const double scale = 1 / std::tan(field_of_view_rad / 2);
    const double near = double{camera.near_distance}, far = double{camera.far_distance};
    camera.projection = {};
    camera.projection[0] = static_cast<float>(scale / aspect);
    camera.projection[5] = static_cast<float>(-scale);
    camera.projection[10] = static_cast<float>(-far / (far - near));
    camera.projection[11] = -1;
    camera.projection[14] = static_cast<float>(-far * near / (far - near));
    camera.previous_view = camera.view;
    camera.previous_projection = camera.projection;
    return camera;
}

ReferenceImage random_hdr(std::uint32_t width, std::uint32_t height, std::uint32_t number) {
    return filled(width, height, [&](std::uint32_t i) {
        const std::uint32_t at = i * 2 + number * 7919;
        const double value = unit(at);
        switch (hash(at + 1) % 8) {
            case 0:
                return -4 * value;
            case 1:
                return 60000 * value;
            case 2:
                return value * 6.0e-5;  // denormal in half precision
            case 3:
                return 16 * value;
            default:
                return value;
        }
    });
}

ReferenceImage random_display(std::uint32_t width, std::uint32_t height, std::uint32_t number) {
    return filled(width, height, [&](std::uint32_t i) { return unit(i + number * 7919); });
}

ReferenceImage uniform(std::uint32_t width, std::uint32_t height, Rgba color) { return {width, height, color}; }

ReferenceImage round_to_half(const ReferenceImage& image) { return mapped(image, half_of); }
ReferenceImage round_to_float(const ReferenceImage& image) {
    return mapped(image, [](double v) { return double{static_cast<float>(v)}; });
}

ReferenceImage develop(const std::function<void(Composer&)>& fill, const ReferenceImage& picture,
                       const RunOptions& options) {
    Device& device = gpu::test::device();
    gpu::Context& context = device.context();
    const std::uint64_t messages = device.validation_messages();
    const VkExtent2D extent{picture.width, picture.height};
    const auto fail = [](std::string_view what, const std::string& text) {
        ADD_FAILURE() << what << ": " << text;
        return ReferenceImage{};
    };

    gpu::test::Picture color = gpu::test::upload(context, to_pixels(picture), options.color, VK_IMAGE_LAYOUT_GENERAL);
    gpu::test::Picture target = gpu::test::blank(context, extent, options.target);
    std::optional<gpu::test::Picture> depth, normals, ui;
    if (options.ui != nullptr)
        ui = gpu::test::upload(context, to_pixels(*options.ui), options.ui_format, VK_IMAGE_LAYOUT_GENERAL);
    if (options.depth != nullptr)
        depth = gpu::test::upload(context, to_pixels(*options.depth), options.depth_format, VK_IMAGE_LAYOUT_GENERAL);
    if (options.normals != nullptr)
        normals = gpu::test::upload(context, to_pixels(*options.normals), VK_FORMAT_R32G32B32A32_SFLOAT,
                                    VK_IMAGE_LAYOUT_GENERAL);
    std::vector<gpu::Image> shadow_maps;
    std::vector<Light> lights;
    for (const ReferenceLight& light : options.lights) {
        lights.push_back(light.light);
        if (light.cascades.empty()) continue;
        shadow_maps.push_back(upload_shadow_map(context, light));
        lights.back().cascades = shadow_map_ref(shadow_maps.back());
        lights.back().cascade_count = static_cast<std::uint32_t>(light.cascades.size());
    }

    Composer composer(device, {.frames_in_flight = 1});
    fill(composer);
    const auto plan = composer.compile({.max_extent = extent,
                                        .color = {options.color, gpu::test::all_usage(context, options.color)},
                                        .is_color_associated = options.is_color_associated,
                                        .depth = {depth ? options.depth_format : VK_FORMAT_UNDEFINED},
                                        .is_depth_planar = depth && options.is_depth_planar,
                                        .normals = {normals ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_UNDEFINED},
                                        .ui = {ui ? options.ui_format : VK_FORMAT_UNDEFINED},
                                        .has_shadows = !shadow_maps.empty(),
                                        .target = {options.target, gpu::test::all_usage(context, options.target)},
                                        .target_color = options.target_color,
                                        .target_domain = options.target_domain,
                                        .kernels = options.kernels,
                                        .fuse = options.fuse,
                                        .intermediate = options.intermediate});
    if (!plan) return fail("compile", plan.error().text);
    if (options.wait_for_lean_kernels) composer.wait_for_kernels();

    Result<> recorded{};
    const auto submitted = gpu::submit_and_wait(context, "develop", [&](VkCommandBuffer commands) {
        Frame frame{.color = image_ref(color),
                    .camera = options.camera,
                    .lights = lights,
                    .time = options.time,
                    .frame_index = options.frame_index,
                    .target = image_ref(target)};
        if (depth) frame.depth = image_ref(*depth);
        if (normals) frame.normals = image_ref(*normals);
        if (ui) frame.ui = image_ref(*ui);
        recorded = composer.record(commands, frame);
    });
    if (!recorded) return fail("record", recorded.error().text);
    if (!submitted) return fail("submit", submitted.error().text);
    const gpu::test::Pixels pixels = gpu::test::download(context, target);
    EXPECT_EQ(device.validation_messages(), messages) << "the validation layer complains";

    ReferenceImage out(extent.width, extent.height);
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
        const float* const p = pixels.rgba.data() + i * 4;
        out.pixels[i] = {p[0], p[1], p[2], p[3]};
    }
    return out;
}

double worst_half_ulps(const ReferenceImage& gpu, const ReferenceImage& reference) {
    if (gpu.pixels.size() != reference.pixels.size()) return 1e9;
    const auto error = [](double value, double expected) {
        if (!std::isfinite(value)) return 1e9;
        const double clamped = std::clamp(std::isnan(expected) ? 0.0 : expected, -65504.0, 65504.0);
        const double magnitude = std::max(std::abs(clamped), std::ldexp(1.0, -10));
        return std::abs(std::clamp(value, -65504.0, 65504.0) - clamped) / std::ldexp(1.0, std::ilogb(magnitude) - 10);
    };
    double worst = 0;
    for (std::size_t i = 0; i < gpu.pixels.size(); ++i) {
        const Rgba &a = gpu.pixels[i], &b = reference.pixels[i];
        worst = std::max({worst, error(a.r, b.r), error(a.g, b.g), error(a.b, b.b), error(a.a, b.a)});
    }
    return worst;
}

double worst_difference(const ReferenceImage& a, const ReferenceImage& b) {
    return worst_difference(a, b, ReferenceImage(a.width, a.height));
}

double worst_difference(const ReferenceImage& a, const ReferenceImage& b, const ReferenceImage& allowance) {
    if (a.pixels.size() != b.pixels.size() || a.pixels.size() != allowance.pixels.size()) return 1e9;
    double worst = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const Rgba &p = a.pixels[i], &q = b.pixels[i], &more = allowance.pixels[i];
        for (const double d : {std::abs(p.r - q.r) - more.r, std::abs(p.g - q.g) - more.g, std::abs(p.b - q.b) - more.b,
                               std::abs(p.a - q.a) - more.a})
            worst = std::isnan(d) ? 1e9 : std::max(worst, d);
    }
    return worst;
}

ReferenceImage filter_loss(const ReferenceImage& picture, double pixels_beside) {
    ReferenceImage out(picture.width, picture.height);
    const double step = gpu::test::filter_step() + pixels_beside;
    if (step == 0) return out;
    for (std::uint32_t y = 0; y < picture.height; ++y)
        for (std::uint32_t x = 0; x < picture.width; ++x) {
            const auto loss = [&](double Rgba::*channel) {
                double low = picture.at(x, y).*channel, high = low;
                for (const int dy : {-1, 0, 1})
                    for (const int dx : {-1, 0, 1}) {
                        const double value = picture.clamped(std::int64_t{x} + dx, std::int64_t{y} + dy).*channel;
                        low = std::min(low, value);
                        high = std::max(high, value);
                    }
                return 2 * step * (high - low);
            };
            out.at(x, y) = {loss(&Rgba::r), loss(&Rgba::g), loss(&Rgba::b), loss(&Rgba::a)};
        }
    return out;
}

void expect_gpu_matches_reference(const EffectInfo& info, const void* parameters, const ReferenceImage& picture,
                                  double ulps) {
    ASSERT_TRUE(info.reference) << info.name;
    const ReferenceImage expected =
        info.reference(parameters, {.picture = &picture, .source = &picture, .second = &picture});
    const auto run = [&](KernelStage stage) {
        return develop(
            [&](Composer& composer) {
                composer.add(info, parameters, info.has_second() ? EntryDesc{.second = scene_color} : EntryDesc{});
            },
            picture, {.kernels = stage});
    };
    const ReferenceImage compute = run(KernelStage::Compute), raster = run(KernelStage::Raster);
    EXPECT_LE(worst_half_ulps(compute, expected), ulps) << info.name << ", compute";
    EXPECT_LE(worst_half_ulps(raster, expected), ulps) << info.name << ", raster";
    EXPECT_LE(worst_difference(compute, raster), gpu::test::code_between_kernels())
        << info.name << ": the stages differ";
}

}  // namespace darkroom::test
