// SPDX-License-Identifier: MIT
#include "hand_written.hpp"

#include <algorithm>

#include "bench/upload.hpp"

namespace darkroom::bench {

namespace {

constexpr VkFormat scene_format = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr VkFormat target_format = VK_FORMAT_R8G8B8A8_UNORM;

// Krzysztof Narkowicz, "ACES Filmic Tone Mapping Curve", 2016; IEC 61966-2-1, its power by the polynomial of
// effects/shared/srgb.glsl. Every value that the effects read from their parameters is read from the block here.
constexpr std::string_view tail_body = R"(
vec4 shade(Pixel pixel) {
    vec4 color = load(scene, pixel.texel);
    vec3 light = color.rgb * exposure;
    light = mix(vec3(0.0), min(light, vec3(1e6)), greaterThan(light, vec3(0.0)));
    light = light * (2.51 * light + 0.03) / (light * (2.43 * light + 0.59) + 0.14);
    light = clamp(light, 0.0, 1.0);

    vec2 offset = pixel.uv - 0.5;
    float falloff = pow(2.0 * dot(offset, offset), 0.5 * vignette_smoothness);
    light *= max(0.0, 1.0 - falloff * vignette_intensity);

    light = mix(vec3(0.0), min(light, vec3(1.0)), greaterThan(light, vec3(0.0)));
    vec3 t = 1.0 - sqrt(sqrt(light));
    vec3 power = 1.0 - t * (1.75715567 + t * (-0.571225668 + t * (-0.127878612 + t * (0.0903737166 - t * 0.0879412007))));
    vec3 code = mix(power, 12.92 * light, lessThanEqual(light, vec3(0.0031308)));

    ivec2 shift = ivec2((frame * uvec2(0xC13FA9A9u, 0x91E10DA6u)) >> 26u);
    vec3 noise = load(tile, (pixel.texel + shift) & 63).rgb;
    vec3 width = max(min(vec3(0.5 * dither_intensity), min(code, 1.0 - code)), vec3(0.0));
    return vec4(code + noise * width, color.a);
}
)";

/// Notes the tables of an effect, and lets it declare passes into the void.
class TableCatcher : public PassBuilder {
  public:
    PassImage picture() override { return {}; }
    PassImage source() override { return {}; }
    std::uint32_t from_max_extent(std::uint32_t (*question)(VkExtent2D)) override { return question({64, 64}); }
    const void* parameters() const override { return parameters_; }
    PassImage create(const PassImageDesc&) override { return {}; }
    History history(const PassImageDesc&) override { return {}; }
    PassImage frame_image(FrameImage) override { return {}; }
    bool has_frame_image(FrameImage) const override { return false; }
    bool is_depth_planar() const override { return false; }
    bool is_velocity_plain() const override { return false; }
    PassImage shadow_map(std::uint32_t) override { return {}; }
    PassImage shared(std::string_view, PassImage (*)(PassBuilder&), ConditionFunction) override { return {}; }
    PassImage table(const TableDesc& desc) override {
        tables.push_back(desc);
        return {};
    }
    PassImage add(const KernelPassDesc&) override { return {}; }
    void side(std::string, PassImage, PassVector) override {}
    void result(PassImage) override {}

    explicit TableCatcher(const void* parameters) : parameters_(parameters) {}
    std::vector<TableDesc> tables;

  private:
    const void* parameters_;
};

/// Everything that one kernel needs to be recorded again and again.
struct KernelRun {
    std::unique_ptr<gpu::Kernel> kernel;
    gpu::DescriptorSets sets;
    gpu::Buffer block;
    gpu::Image table;
    std::vector<gpu::Binding> images;
    gpu::Binding output;
};

Result<> fill(Bed& bed, KernelRun& run, const gpu::KernelSpec& spec, gpu::Stage stage,
              std::span<const std::uint32_t> words) {
    DARKROOM_TRY_VALUE(run.kernel, gpu::Kernel::create(bed.context, spec, stage));
    const VkDescriptorSetLayout layout = run.kernel->set_layout();
    DARKROOM_TRY_VALUE(run.sets, gpu::DescriptorSets::create(bed.context, {&layout, 1}));
    const std::size_t bytes = gpu::own_block_size(spec);
    DARKROOM_TRY_VALUE(run.block,
                       gpu::Buffer::create(bed.context, bytes, gpu::block_usage, gpu::Memory::Kind::Upload, "block"));

    const gpu::Region region{.extent = bed.extent, .image = bed.extent};
    run.output = {.view = bed.target.mip_views[0], .region = region};
    run.images.push_back({.view = bed.scene.mip_views[0], .region = region});
    if (spec.images.size() > 1) {
        const VkExtent2D size{run.table.info.extent.width, run.table.info.extent.height};
        run.images.push_back({.view = run.table.mip_views[0], .region = {.extent = size, .image = size}});
    }
    gpu::write_own_block(spec, region, run.images, {}, words, {run.block.memory.mapped, bytes});
    run.kernel->write_set({.set = run.sets.sets[0],
                           .own = {run.block.handle, 0, bytes},
                           .images = run.images,
                           .outputs = {&run.output, 1}});
    return {};
}

}  // namespace

gpu::KernelSpec calibration_spec() {
    return {.name = "calibration",
            .images = {{.name = "scene", .storage_format = scene_format}},
            .outputs = {target_format},
            .is_whole = true,
            .body = "vec4 shade(Pixel pixel) { return load(scene, pixel.texel); }"};
}

gpu::KernelSpec tail_spec(const gpu::Context& context) {
    return {.name = "hand-written tail",
            .images = {{.name = "scene", .storage_format = scene_format},
                       {.name = "tile", .storage_format = VK_FORMAT_R32G32B32A32_SFLOAT}},
            .outputs = {target_format},
            .is_whole = true,
            .members = {{gpu::BlockMember::Type::Float, "exposure"},
                        {gpu::BlockMember::Type::Float, "vignette_intensity"},
                        {gpu::BlockMember::Type::Float, "vignette_smoothness"},
                        {gpu::BlockMember::Type::Float, "dither_intensity"},
                        {gpu::BlockMember::Type::Uint, "frame"}},
            .body = std::string(tail_body),
            .workgroup = gpu::usual_workgroup(context)};
}

std::optional<TableDesc> only_table_of(const EffectInfo& effect) {
    if (effect.build == nullptr) return std::nullopt;
    TableCatcher catcher(effect.parameters.defaults.data());
    effect.build(catcher);
    if (catcher.tables.size() != 1) return std::nullopt;
    return std::move(catcher.tables.front());
}

double one_pass_bytes(const Bed& bed) {
    constexpr double scene_bytes = 8, target_bytes = 4;
    return (scene_bytes + target_bytes) * bed.extent.width * bed.extent.height;
}

Result<Row> kernel_row(Bed& bed, std::string name, const gpu::KernelSpec& spec, gpu::Stage stage,
                       std::span<const std::uint32_t> words, const TableDesc* table) {
    const auto run = std::make_shared<KernelRun>();
    if (table != nullptr) {
        DARKROOM_TRY_VALUE(run->table, upload_table(bed.context, *table));
    }
    DARKROOM_TRY(fill(bed, *run, spec, stage, words));
    const VkImageLayout layout =
        stage == gpu::Stage::Compute ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    return Row{.name = std::move(name),
               .record = [&bed, run, layout](VkCommandBuffer commands) -> Result<> {
                   gpu::transition(bed.context, commands, bed.target, VK_IMAGE_LAYOUT_GENERAL, layout);
                   run->kernel->record(commands, run->sets.sets[0], {&run->output, 1});
                   gpu::transition(bed.context, commands, bed.target, layout, VK_IMAGE_LAYOUT_GENERAL);
                   return {};
               },
               .moved_bytes = one_pass_bytes(bed)};
}

}  // namespace darkroom::bench
