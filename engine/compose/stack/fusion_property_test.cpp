// SPDX-License-Identifier: MIT
// The picture does not depend on fusion, ever: random graphs of all effects and of some that no library ships, with
// wires to any entry before, entries left out, every kind and domain of target, and edits after compile. Fused in both
// stages, unfused, compiled again and, where the stack has one, the reference give one picture.

#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>

#include "compose/test_stacks/effects.hpp"
#include "compose/test_stacks/random_scene.hpp"
#include "core/test_support_small.hpp"
#include "develop/reference_chain.hpp"
#include "shared/srgb_reference.hpp"

namespace darkroom {
namespace {

using test::below;
using test::one_in;

// Effects whose passes write several images, compute in shared memory, and make and read values.
struct Gauge {
    float amount = 1;
};
struct Heed {
    float amount = 1;
};
struct Parted {
    float amount = 1;
};
struct Tile {
    float amount = 1;
};

constexpr std::array<EffectFile, 6> pass_effect_files{{
    // Always in the same order, so that nothing but the picture decides over the sum.
    {"gauge_sum.glsl",
     "shared float gauge_parts[64];\n"
     "void run() {\n"
     "    uint own = gl_LocalInvocationIndex;\n"
     "    ivec2 extent = size(gauge_in);\n"
     "    float sum = 0.0;\n"
     "    for (int i = int(own); i < extent.x * extent.y; i += 64)\n"
     "        sum += clamp(load(gauge_in, ivec2(i % extent.x, i / extent.x)).r, 0.0, 1.0);\n"
     "    gauge_parts[own] = sum;\n"
     "    barrier();\n"
     "    if (own != 0u) return;\n"
     "    for (int i = 1; i < 64; ++i) sum += gauge_parts[i];\n"
     "    gauge_mean[0] = sum / float(extent.x * extent.y);\n}\n"},
    {"gauge.glsl",
     "vec4 gauge(vec4 color, Pixel pixel, Gauge parameters) {\n"
     "    return vec4(color.rgb * (1.0 - parameters.amount * gauge_mean[0]), color.a);\n}\n"},
    {"heed.glsl",
     "vec4 heed(vec4 color, Pixel pixel, Heed parameters) {\n"
     "    return vec4(color.rgb * (1.0 - parameters.amount * heed_mean[0]), color.a);\n}\n"},
    {"parted_parts.glsl",
     "void shade(Pixel pixel, out vec4 result[2]) {\n"
     "    vec4 color = load(parted_in, pixel.texel);\n"
     "    result[0] = 0.5 * color;\n"
     "    result[1] = 0.25 * color.bgra;\n}\n"},
    {"parted.glsl",
     "vec4 parted(vec4 color, Pixel pixel, Parted parameters) {\n"
     "    vec3 apart = sample_linear(parted_half, pixel.uv).rgb - sample_linear(parted_turned, pixel.uv).rgb;\n"
     "    return vec4(color.rgb + parameters.amount * apart, color.a);\n}\n"},
    {"tile_rows.glsl",
     "shared vec4 tile_texels[4][18];\n"
     "void run() {\n"
     "    ivec2 texel = ivec2(gl_GlobalInvocationID.xy), place = ivec2(gl_LocalInvocationID.xy);\n"
     "    vec4 own = load_clamped(tile_in, texel);\n"
     "    tile_texels[place.y][place.x + 1] = own;\n"
     "    if (place.x == 0) tile_texels[place.y][0] = load_clamped(tile_in, texel - ivec2(1, 0));\n"
     "    if (place.x == 15) tile_texels[place.y][17] = load_clamped(tile_in, texel + ivec2(1, 0));\n"
     "    barrier();\n"
     "    if (any(greaterThanEqual(texel, size(tile_out)))) return;\n"
     "    vec3 beside = 0.5 * (tile_texels[place.y][place.x].rgb + tile_texels[place.y][place.x + 2].rgb);\n"
     "    store(tile_out, texel, vec4(own.rgb + tile_parameters().amount * (beside - own.rgb), own.a));\n}\n"},
}};

ReferenceImage gauge_reference(const void* parameters, const ReferenceInput& input) {
    double sum = 0;
    for (const Rgba& pixel : input.source->pixels) sum += std::clamp(pixel.r, 0.0, 1.0);
    const double mean = sum / static_cast<double>(input.source->pixels.size());
    const double factor = 1 - mean * double{static_cast<const Gauge*>(parameters)->amount};
    ReferenceImage out = *input.picture;
    for (Rgba& p : out.pixels) p = {p.r * factor, p.g * factor, p.b * factor, p.a};
    return out;
}

ReferenceImage parted_reference(const void* parameters, const ReferenceInput& input) {
    ReferenceImage out = *input.picture;
    const double amount{static_cast<const Parted*>(parameters)->amount};
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
        const Rgba& from = input.source->pixels[i];
        Rgba& p = out.pixels[i];
        p = {p.r + amount * (0.5 * from.r - 0.25 * from.b), p.g + amount * 0.25 * from.g,
             p.b + amount * (0.5 * from.b - 0.25 * from.r), p.a};
    }
    return out;
}

ReferenceImage tile_reference(const void* parameters, const ReferenceInput& input) {
    const ReferenceImage& picture = *input.picture;
    const double amount{static_cast<const Tile*>(parameters)->amount};
    ReferenceImage out = picture;
    for (std::uint32_t y = 0; y < out.height; ++y) {
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const Rgba &left = picture.at(x == 0 ? 0 : x - 1, y),
                       &right = picture.at(std::min(x + 1, out.width - 1), y);
            Rgba& pixel = out.at(x, y);
            for (double Rgba::*const channel : {&Rgba::r, &Rgba::g, &Rgba::b})
                pixel.*channel += amount * (0.5 * (left.*channel + right.*channel) - pixel.*channel);
        }
    }
    return out;
}

constexpr auto gauge_rows = describe(field<&Gauge::amount>("How much darker a bright picture gets.", {0, 1}));
constexpr auto heed_rows = describe(field<&Heed::amount>("The same, of an earlier entry.", {0, 1}));
constexpr auto parted_rows = describe(field<&Parted::amount>("How far the parts are apart.", {0, 1}));
constexpr auto tile_rows = describe(field<&Tile::amount>("How much of the neighbours is seen.", {0, 1}));

/// A value of the entry's own, for its end and for entries behind.
const EffectInfo gauge_effect{
    .name = "gauge",
    .doc = "Darkens by the mean of red.",
    .parameters = gauge_rows.table(),
    .files = pass_effect_files,
    .build =
        [](PassBuilder& builder) {
            const PassBuffer mean = builder.value("mean", 1);
            builder.add_compute({.name = "sum",
                                 .shader = "gauge_sum.glsl",
                                 .inputs = {{.name = "gauge_in", .image = builder.source()}},
                                 .buffers = {{"gauge_mean", mean, ComputePassDesc::Access::Write, "float"}},
                                 .workgroup = {64, 1},
                                 .shared_bytes = 256,
                                 .groups = {1, 1}});
            builder.value_side("gauge_mean", mean);
        },
    .reference = gauge_reference};
/// Reads the value of an entry before it, or one that nobody writes.
const EffectInfo heed_effect{.name = "heed",
                             .doc = "Darkens by what an entry before it measured.",
                             .parameters = heed_rows.table(),
                             .files = pass_effect_files,
                             .build = [](PassBuilder& builder) {
                                 const PassBuffer mean = builder.find_value("mean");
                                 builder.value_side("heed_mean", mean.is_given() ? mean : builder.value("nothing", 1));
                             }};
/// Two images of one pass.
const EffectInfo parted_effect{
    .name = "parted",
    .doc = "Adds what two images differ by.",
    .parameters = parted_rows.table(),
    .files = pass_effect_files,
    .build =
        [](PassBuilder& builder) {
            const auto image = [&](const char* name) {
                return builder.create({.name = name, .format = VK_FORMAT_R32G32B32A32_SFLOAT});
            };
            const auto made = builder.add_all({.name = "parts",
                                               .shader = "parted_parts.glsl",
                                               .inputs = {{.name = "parted_in", .image = builder.source()}},
                                               .output = image("half"),
                                               .more_outputs = {image("turned")}});
            if (made.size() < 2) return;
            builder.side("parted_half", made[0], {});
            builder.side("parted_turned", made[1], {});
        },
    .reference = parted_reference};
/// A result that a compute pass makes in shared memory.
const EffectInfo tile_effect{
    .name = "tile",
    .doc = "Averages the neighbours in the row.",
    .parameters = tile_rows.table(),
    .files = pass_effect_files,
    .touch = Touch::Neighbourhood,
    .build =
        [](PassBuilder& builder) {
            const PassImage out = builder.create({.name = "rows", .format = VK_FORMAT_R32G32B32A32_SFLOAT});
            const auto made = builder.add_compute({.name = "rows",
                                                   .shader = "tile_rows.glsl",
                                                   .inputs = {{.name = "tile_in", .image = builder.picture()}},
                                                   .outputs = {{"tile_out", out}},
                                                   .workgroup = {16, 4},
                                                   .shared_bytes = 16 * 18 * 4});
            if (!made.empty()) builder.result(made[0]);
        },
    .reference = tile_reference};

class ComposeFusionProperty : public test::StackTest {};
class SoakFusionProperty : public test::StackTest {};

constexpr VkFormat float_format = VK_FORMAT_R32G32B32A32_SFLOAT;
/// What takes long are kernels: effects of many come into few of the graphs that every change is tried with.
enum class Effort : std::uint8_t { Small, Thorough };

constexpr std::array<const EffectInfo*, 11> test_effects{
    &test::shift_effect,  &test::cross_effect, &test::glow_effect,   &test::recode_effect,
    &test::absent_effect, &test::halve_effect, &test::absent_effect, &gauge_effect,
    &heed_effect,         &parted_effect,      &tile_effect};
bool is_test_effect(const EffectInfo& info) { return std::ranges::find(test_effects, &info) != test_effects.end(); }

std::vector<const EffectInfo*> effects_for(Effort effort) {
    std::vector<const EffectInfo*> effects(test_effects.begin(), test_effects.end());
    // Each kernel is compiled in several forms, so a test in a hurry takes few effects with passes.
    constexpr std::array<std::string_view, 3> with_passes{"dither", "fog", "gaussian_blur"};
    for (const EffectInfo* const info : all_effects()) {
        const bool is_small = !info->build || std::ranges::find(with_passes, info->name) != with_passes.end();
        if (effort == Effort::Thorough || is_small) effects.push_back(info);
    }
    return effects;
}

/// What the host's frames are, beside their size.
struct Surroundings {
    explicit Surroundings(std::mt19937& random) {
        constexpr std::array formats{float_format, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B8G8R8A8_UNORM,
                                     VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_R16G16B16A16_SFLOAT};
        constexpr std::array<std::optional<Domain>, 5> domains{std::nullopt, Domain::Encoded, Domain::Encoded,
                                                               Domain::SceneLinear, Domain::DisplayLinear};
        constexpr std::array<std::optional<bool>, 4> encodes{std::nullopt, std::nullopt, true, false};
        format = formats[below(random, formats.size())];
        domain = domains[below(random, domains.size())];
        encodes_target = encodes[below(random, encodes.size())];
    }
    [[nodiscard]] bool is_float() const { return format == float_format || format == VK_FORMAT_R16G16B16A16_SFLOAT; }
    [[nodiscard]] std::string described() const {
        return fmt::format("\n# target format {}, domain {}, encodes {}", static_cast<int>(format),
                           domain ? static_cast<int>(*domain) : -1, encodes_target ? int{*encodes_target} : -1);
    }
    VkFormat format = float_format;
    std::optional<Domain> domain;
    std::optional<bool> encodes_target;
};

ReferenceImage picture_of(std::mt19937& random) {
    constexpr std::array<VkExtent2D, 5> sizes{{{24, 16}, {19, 13}, {1, 1}, {9, 2}, {33, 8}}};
    const VkExtent2D size = sizes[below(random, sizes.size())];
    ReferenceImage picture = test::random_display(size.width, size.height, static_cast<std::uint32_t>(random()));
    for (Rgba& pixel : picture.pixels) pixel = {pixel.r * 4.5 - 0.5, pixel.g * 4.5 - 0.5, pixel.b * 4.5 - 0.5, 1};
    return test::round_to_float(picture);
}

/// One stack, held by composers that plan it in different ways, and one frame to show each of them.
class Graph {
  public:
    Graph(std::uint32_t seed, Effort effort)
        : random_(seed * 2654435761U + 101),
          effects_(effects_for(effort)),
          surroundings_(random_),
          picture_(picture_of(random_)),
          host_(picture_, float_format, float_format),
          stack_seed_(static_cast<std::uint32_t>(random_())),
          text_(fmt::format("seed {}{}", seed, surroundings_.described())) {
        if (one_in(random_, effort == Effort::Small ? 6 : 2)) {
            const VkExtent2D extent{picture_.width, picture_.height};
            scene_.emplace(random_, host_.device, test::RandomScene::Desc{.extent = extent});
            text_ += scene_->described();
        }
    }

    [[nodiscard]] Composer composer() const {
        Composer made(host_.device);
        std::mt19937 random(stack_seed_);
        test::fill_random(random, made, {.effects = effects_, .one_input_in = 2, .has_sizes = true});
        return made;
    }
    /// Empty, with a failure, where the stack cannot be compiled.
    [[nodiscard]] std::optional<Plan> compile(Composer& composer, KernelStage stage, bool is_fused) {
        CompileDesc desc = host_.compile_desc();
        desc.target = {surroundings_.format, gpu::test::all_usage(host_.device.context(), surroundings_.format) &
                                                 (VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT)};
        desc.target_domain = surroundings_.domain;
        desc.encodes_target = surroundings_.encodes_target;
        desc.kernels = stage;
        desc.fuse = is_fused;
        if (scene_) scene_->tell(desc);
        auto plan = composer.compile(desc);
        if (!plan) {
            ADD_FAILURE() << plan.error().text;
            return std::nullopt;
        }
        if (!target_)
            target_ = gpu::test::blank(host_.device.context(), plan->passes.back().extent, desc.target.format);
        return std::move(*plan);
    }
    [[nodiscard]] ReferenceImage show(Composer& composer) const {
        Frame frame = host_.frame();
        if (scene_) scene_->tell(frame);
        frame.target = test::image_ref(*target_);
        frame.time = 1.5;
        frame.frame_index = 90;
        frame.camera.is_cut = true;  // what lies a frame back is black, each time
        test::must(host_.record(composer, frame));
        return test::image_of(gpu::test::download(host_.device.context(), *target_));
    }
    /// What the target holds by the references alone; empty where they cannot tell.
    [[nodiscard]] std::optional<ReferenceImage> reference(const Composer& composer) const {
        if (scene_) return std::nullopt;
        for (std::size_t i = 0; i < composer.size(); ++i) {
            const EffectInfo& info = *composer.info(composer.entry(i));
            // Passes of the library keep half floats, which references do not; and entries of two sizes meet through a
            // bilinear tap.
            const bool is_exact = info.build == nullptr || is_test_effect(info);
            const EntryDesc& desc = *composer.desc(composer.entry(i));
            if (desc.scale.denominator != 1) return std::nullopt;
            if (&info == &test::absent_effect) continue;
            // What compares or counts levels may fall to the other side by a rounding.
            if (info.name == "fxaa" || info.name == "posterize") return std::nullopt;
            if (!info.reference || !is_exact || info.output_scale.denominator != 1) return std::nullopt;
        }
        const bool is_srgb = surroundings_.format == VK_FORMAT_R8G8B8A8_SRGB;
        const Domain domain =
            surroundings_.domain.value_or(surroundings_.is_float() ? Domain::SceneLinear : Domain::Encoded);
        auto made = run_reference(
            composer, {.color = &picture_,
                       .time = 1.5,
                       .frame_index = 90,
                       .target_domain = domain,
                       .encodes_target = is_srgb || surroundings_.encodes_target.value_or(!surroundings_.is_float())});
        if (!made) {
            ADD_FAILURE() << made.error().text;
            return std::nullopt;
        }
        // The format encodes what the library does not.
        if (is_srgb && domain != Domain::Encoded)
            for (Rgba& p : made->picture.pixels) p = {encoded(p.r), encoded(p.g), encoded(p.b), p.a};
        return std::move(made->picture);
    }

    [[nodiscard]] std::uint32_t edits_seed() { return static_cast<std::uint32_t>(random_()); }
    [[nodiscard]] const std::string& text() const { return text_; }

  private:
    static double encoded(double value) { return srgb_encoded(std::clamp(value, 0.0, 1.0)); }

    std::mt19937 random_;
    std::vector<const EffectInfo*> effects_;
    Surroundings surroundings_;
    ReferenceImage picture_;
    test::Host host_;
    std::uint32_t stack_seed_;
    std::string text_;
    std::optional<test::RandomScene> scene_;
    std::optional<gpu::test::Picture> target_;
};

/// The values of a stack that its passes may depend on.
std::vector<std::uint32_t> read_at_compile(const Composer& composer) {
    std::vector<std::uint32_t> out;
    for (std::size_t i = 0; i < composer.size(); ++i) {
        const Handle entry = composer.entry(i);
        for (const ParamInfo& row : composer.info(entry)->parameters.rows) {
            const auto words = composer.words(entry).subspan(row.word, row.words);
            if (row.is_at_compile) out.insert(out.end(), words.begin(), words.end());
        }
    }
    return out;
}

struct Count {
    std::size_t saved = 0;       ///< kernels, by fusing
    std::size_t references = 0;  ///< pictures that had one
};

void expect_one_picture(std::uint32_t seed, Effort effort, Count& count) {
    Graph graph(seed, effort);
    Composer fused = graph.composer(), unfused = graph.composer(), raster = graph.composer();
    SCOPED_TRACE(graph.text() + test::described(fused));
    const bool is_thorough = effort == Effort::Thorough;
    const bool tries_raster = is_thorough || seed % 4 == 0, tries_again = is_thorough || seed % 4 == 1;
    const auto plan = graph.compile(fused, KernelStage::Compute, true);
    const auto unfused_plan = graph.compile(unfused, KernelStage::Auto, false);
    if (!plan || !unfused_plan) return;
    if (tries_raster && !graph.compile(raster, KernelStage::Raster, true)) return;
    count.saved += unfused_plan->passes.size() - std::min(plan->passes.size(), unfused_plan->passes.size());
    const int rounds = is_thorough ? 3 : 2;
    for (int round = 0; round < rounds; ++round) {
        if (round > 0) {
            const std::uint32_t edits = graph.edits_seed();
            for (Composer* const composer : {&fused, &raster, &unfused}) {
                std::mt19937 random(edits);
                test::edit_random(random, *composer, test::Values::Sane);
            }
        }
        SCOPED_TRACE(fmt::format("after {} edits:{}", round, round > 0 ? test::described(fused) : ""));
        const ReferenceImage picture = graph.show(fused);
        const ReferenceImage apart = graph.show(unfused);
        EXPECT_LE(test::worst_codes(apart, picture), 1) << "unfused differs";
        if (plan->passes.size() == unfused_plan->passes.size() && gpu::test::is_lavapipe()) {
            EXPECT_EQ(test::worst_difference(apart, picture), 0) << "unfused differs where nothing was fused";
        }
        if (tries_raster) {
            EXPECT_LE(test::worst_codes(graph.show(raster), picture), gpu::test::is_lavapipe() ? 0 : 1)
                << "the stages differ";
        }
        if (const auto expected = graph.reference(fused)) {
            ++count.references;
            // Each pass may filter, along both axes, values in [0,1].
            const double filtered =
                std::ceil(255 * 2 * gpu::test::filter_step() * static_cast<double>(plan->passes.size()));
            EXPECT_LE(test::worst_codes(picture, *expected), 1 + filtered) << "the reference differs";
        }
        if (!tries_again || round + 1 < rounds) continue;
        fused.wait_for_kernels();
        EXPECT_EQ(test::worst_difference(graph.show(fused), picture), 0) << "the lean kernels differ";
        // What was compiled with other values must not be told from what is compiled with these, but for those that are
        // read at compile.
        const auto compiled = read_at_compile(graph.composer()), now = read_at_compile(unfused);
        if (!graph.compile(unfused, KernelStage::Auto, false)) return;
        if (compiled != now) continue;
        EXPECT_EQ(test::worst_difference(graph.show(unfused), apart), 0) << "compiled again it differs";
    }
}

TEST_F(ComposeFusionProperty, AGraphIsOnePictureHoweverItIsPlanned) {
    Count count;
    const std::uint32_t graphs = test::is_small() ? 48 : 200;
    for (std::uint32_t seed = 0; seed < graphs; ++seed) expect_one_picture(seed, Effort::Small, count);
    EXPECT_GE(count.saved, graphs / 2) << "little was fused";
    EXPECT_GE(count.references, graphs / 4) << "few stacks had a reference";
}

TEST_F(ComposeFusionProperty, EffectsOfManyKernelsAreNoException) {
    Count count;
    for (std::uint32_t seed = 200; seed < (test::is_small() ? 202U : 208U); ++seed)
        expect_one_picture(seed, Effort::Thorough, count);
}

TEST_F(SoakFusionProperty, AGraphIsOnePictureHoweverItIsPlanned) {
    Count count;
    for (std::uint32_t seed = 1000; seed < 3500; ++seed) expect_one_picture(seed, Effort::Thorough, count);
    EXPECT_GE(count.saved, 1000U) << "little was fused";
}

}  // namespace
}  // namespace darkroom
