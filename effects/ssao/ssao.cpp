// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/ssao.hpp>
#include <numbers>

#include "shared/scene_images.hpp"
#include "ssao/ssao_reference.hpp"

namespace darkroom {

namespace {

constexpr auto ssao_rows = describe(
    field<&Ssao::intensity>("Share of the occlusion that darkens the picture.", {0, 8}).as_amount(),
    field<&Ssao::radius>("Distance up to which surfaces occlude.", {0.001, 1000}, unit::metres),
    field<&Ssao::bias>("Distance below which a surface does not occlude; it hides the steps of the depth buffer.",
                       {0, 100}, unit::metres),
    field<&Ssao::thickness>("Depth that surfaces reach behind what is seen of them, for ground_truth; 0 has no end.",
                            {0, 1000}, unit::metres),
    field<&Ssao::samples>("Number of depth reads for a pixel.", {1, 64}).as_loop_count(),
    field<&Ssao::method>("Estimator of the occlusion."),
    field<&Ssao::resolution>(
        "Size of the occlusion, as a share of each side; half is brought back to full along depth edges."),
    field<&Ssao::merge>("Formula that darkens the picture by the occlusion."),
    field<&Ssao::fade_start>("Distance at which occlusion begins to fade.", {0, 1e9}, unit::metres),
    field<&Ssao::fade_end>("Distance at which occlusion is gone; it must lie beyond `fade_start`.", {0.001, 1e9},
                           unit::metres),
    field<&Ssao::moves>("Changes the noise in each frame while time runs, for filters that average frames."));

const Ssao& ssao_of(const void* parameters) { return *static_cast<const Ssao*>(parameters); }

/// xorshift32 with the shifts 13, 17, 5 (Marsaglia, "Xorshift RNGs", 2003); [0, 1) from the low 24 bits.
class Random {
  public:
    explicit Random(std::uint32_t seed) : state_(seed) {}
    float next() {
        state_ ^= state_ << 13;
        state_ ^= state_ >> 17;
        state_ ^= state_ << 5;
        return static_cast<float>(state_ & 0xFFFFFFu) / 16777216.0f;
    }

  private:
    std::uint32_t state_;
};

constexpr std::int32_t max_slices = 4;

/// Between texels of an image of `extent`, each the first of `step` pixels of the frame, and view space: see the
/// shader.
void camera_constants(const Camera& camera, VkExtent2D frame, VkExtent2D extent, float step,
                      std::span<PassVector> out) {
    const Matrix& p = camera.projection;
    const auto [ray, flat] = ray_constants(camera, frame, step);
    out[0] = ray;
    out[1] = flat;
    const float down = camera.is_y_down ? 1.0f : -1.0f;
    const std::array<float, 2> scale{p[0], p[5] * down}, shear{p[8], p[9] * down}, offset{p[12], p[13] * down};
    const std::array<std::uint32_t, 2> pixels{frame.width, frame.height}, texels{extent.width, extent.height};
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const float half = 0.5f * static_cast<float>(pixels[axis]) / step;
        out[2][axis] = scale[axis] * half;
        out[2][axis + 2] = shear[axis] * half;
        out[3][axis] = offset[axis] * half;
        out[4][axis] = half + 0.5f - 0.5f / step;
        out[4][axis + 2] = static_cast<float>(texels[axis]) - 0.01f;
    }
    out[3][2] = p[11];
    out[3][3] = p[15];
}

PassVector turn(double angle) { return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))}; }

void occlusion_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const Ssao& ssao = ssao_of(parameters);
    camera_constants(*context.camera, context.frame_extent, context.output_extent,
                     ssao.resolution == SsaoResolution::Half ? 2.0f : 1.0f, out);
    out[5] = {ssao.radius, 1.0f / ssao.radius, ssao.bias, ssao.intensity};
    out[6] = {ssao.fade_start, 1.0f / std::max(ssao.fade_end - ssao.fade_start, 1e-6f),
              ssao.thickness > 0 ? ssao.thickness : ssao_endless,
              std::bit_cast<float>(ssao.moves ? ssao_tile(context.time, context.frame_index) : 0U)};
}

void surface_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const auto [ray, flat] = ray_constants(*context.camera, context.frame_extent,
                                           ssao_of(parameters).resolution == SsaoResolution::Half ? 2.0f : 1.0f);
    out[0] = ray;
    out[1] = flat;
}

void upsample_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    depth_vectors(parameters, context, out);
    const auto [ray, flat] = ray_constants(*context.camera, context.frame_extent, 1);
    out[1][1] = ray[0];
    out[1][2] = flat[0];
}

template <SsaoResolution resolution>
bool is_size_used(const void* parameters, const PassContext&, std::uint32_t) {
    return ssao_of(parameters).resolution == resolution;
}

template <SsaoResolution resolution>
PassImage add_chain(PassBuilder& builder, PassImage turns) {
    constexpr bool is_half = resolution == SsaoResolution::Half;
    const bool has_normals = builder.has_frame_image(FrameImage::Normals);
    const NormalSource source = has_normals ? NormalSource::Image : NormalSource::Depth;
    const ConditionFunction condition = is_size_used<resolution>;
    const PassImage normals =
        is_half ? half_view_normals(builder, source, condition) : view_normals(builder, source, condition);
    const std::string suffix = is_half ? "" : " full size";
    const auto create = [&](const char* name, VkFormat format) {
        return builder.create({.name = name + suffix, .format = format, .denominator = is_half ? 2u : 1u});
    };
    const auto distance_of = has_normals ? (is_half ? half_surface_distance : surface_distance) : half_depth;
    const PassImage distance = is_half || has_normals ? distance_of(builder, condition) : linear_depth(builder);
    const PassImage raw = builder.add({.name = "occlusion" + suffix,
                                       .shader = "ssao_occlusion.glsl#occlusion",
                                       .inputs = {{.name = "ssao_distance", .image = distance},
                                                  {.name = "ssao_normals", .image = normals},
                                                  {.name = "ssao_turns", .image = turns}},
                                       .output = create("raw", VK_FORMAT_R32_SFLOAT),
                                       .custom_vectors = 7,
                                       .constants = occlusion_constants,
                                       .condition = condition});
    const PassImage blurred =
        builder.add({.name = "blur" + suffix,
                     .shader = "ssao.glsl#blur",
                     .inputs = {{.name = "ssao_raw", .image = raw}, {.name = "ssao_normals", .image = normals}},
                     .output = create("tile", VK_FORMAT_R32G32_SFLOAT),
                     .custom_vectors = 2,
                     .constants = surface_constants,
                     .condition = condition});
    const PassImage widened =
        builder.add({.name = "widen" + suffix,
                     .shader = "ssao.glsl#widen",
                     .inputs = {{.name = "ssao_tile", .image = blurred}, {.name = "ssao_normals", .image = normals}},
                     .output = create("blurred", VK_FORMAT_R32G32_SFLOAT),
                     .custom_vectors = 2,
                     .constants = surface_constants,
                     .condition = condition});
    if (!is_half) return widened;
    std::vector<KernelPassDesc::Input> inputs{{.name = "ssao_blurred", .image = widened},
                                              {.name = "ssao_depth", .image = builder.frame_image(FrameImage::Depth)}};
    if (has_normals)
        inputs.push_back({.name = "ssao_frame_normals", .image = builder.frame_image(FrameImage::Normals)});
    return builder.add({.name = "upsample",
                        .shader = has_normals ? "ssao.glsl#upsample_by_normals" : "ssao.glsl#upsample",
                        .inputs = std::move(inputs),
                        .output = create("upsampled", VK_FORMAT_R16G16B16A16_SFLOAT),
                        .custom_vectors = 2,
                        .constants = upsample_constants,
                        .condition = condition});
}

void build(PassBuilder& builder) {
    // Rows 0 to 3: turns of the kernel; then, for one slice, two and so on, the first direction.
    const auto noise = ssao_noise();
    std::vector<PassVector> turns;
    for (const auto& texel : noise) turns.push_back({texel[0], texel[1], 0, 0});
    for (std::int32_t slices = 1; slices <= max_slices; ++slices)
        for (const auto& texel : noise) turns.push_back(turn(std::numbers::pi / slices * double{texel[2]} / 16));
    TableDesc table{.name = "ssao turns",
                    .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                    .extent = {4, static_cast<std::uint32_t>(turns.size() / 4), 1},
                    .is_load_only = true,
                    .data = std::vector<std::byte>(turns.size() * sizeof turns[0])};
    std::memcpy(table.data.data(), turns.data(), table.data.size());
    const PassImage turns_table = builder.table(table);
    builder.side("ssao_half", add_chain<SsaoResolution::Half>(builder, turns_table), {1, 1, 1, 1});
    // All its last ten bits are set: visible.
    builder.side("ssao_full", add_chain<SsaoResolution::Full>(builder, turns_table),
                 {std::bit_cast<float>(0x3F8003FFu), 0, 0, 0});
}

std::string conflict(const void* parameters) {
    const Ssao& ssao = ssao_of(parameters);
    if (ssao.fade_end > ssao.fade_start) return {};
    return fmt::format("fade_end = {}: must lie beyond fade_start = {} m", ssao.fade_end, ssao.fade_start);
}

}  // namespace

std::array<std::array<float, 3>, 64> ssao_kernel(std::size_t count) {
    std::array<std::array<float, 3>, 64> out{};
    Random random(0xDEADBEEF);
    for (std::size_t i = 0; i < std::min(count, out.size()); ++i) {
        const float x = random.next() * 2 - 1, y = random.next() * 2 - 1, z = random.next();
        const float share = static_cast<float>(i) / static_cast<float>(count);
        const float length = random.next() * (0.1f + 0.9f * share * share) / std::max(std::hypot(x, y, z), 1e-6f);
        out[i] = {x * length, y * length, z * length};
    }
    return out;
}

std::array<std::array<float, 4>, 16> ssao_noise() {
    std::array<std::array<float, 4>, 16> out{};
    for (std::uint32_t y = 0; y < 4; ++y) {
        for (std::uint32_t x = 0; x < 4; ++x) {
            const std::uint32_t number = ((x + y) % 4) * 4 + x;
            const double angle = 2 * std::numbers::pi * number / 16;
            out[y * 4 + x] = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)),
                              static_cast<float>(number), static_cast<float>((y + 4 - x) % 4) / 4 + 0.125f};
        }
    }
    return out;
}

std::uint32_t ssao_tile(double time, std::uint64_t frame_index) {
    return time > 0.0 ? static_cast<std::uint32_t>(frame_index % 16) : 0;
}

std::array<std::int32_t, 2> ssao_slices(std::int32_t samples) {
    const auto slices = std::clamp(static_cast<std::int32_t>(std::lround(std::sqrt(samples / 4.0))), 1, max_slices);
    return {slices, std::max(1, samples / (2 * slices))};
}

const EffectInfo& effect_info(const Ssao&) {
    static const EffectInfo info{
        .name = "ssao",
        .doc = "Darkens corners and contacts, which light from all around reaches less.",
        .parameters = ssao_rows.table(),
        .files = embedded_files("ssao"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::SceneLinear) | Domains::only(Domain::DisplayLinear),
        .needs = {FrameImage::Depth},
        .flat = {.documented = 30, .scene_linear = 10, .starts_on = true, .toggle_key = 7},
        .is_in_traced_light = true,
        .build = build,
        .reference = ssao_reference,
        .conflict = conflict,
        .is_identity = [](const void* parameters) { return ssao_of(parameters).intensity == 0.0f; },
    };
    return info;
}

}  // namespace darkroom
