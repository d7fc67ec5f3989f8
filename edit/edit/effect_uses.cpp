// SPDX-License-Identifier: MIT
#include "edit/effect_uses.hpp"

#include <algorithm>
#include <darkroom/pass_builder.hpp>

namespace darkroom::edit {

namespace {

/// Takes down what is asked for, and gives an image of its own for each.
class Listener final : public PassBuilder {
  public:
    explicit Listener(const EffectInfo& effect) : effect_(effect) {}

    EffectUses uses;

    PassImage picture() override { return {0}; }
    PassImage source() override {
        uses.reads_source = true;
        return {1};
    }
    std::uint32_t from_max_extent(std::uint32_t (*question)(VkExtent2D)) override { return question({1920, 1080}); }
    const void* parameters() const override { return effect_.parameters.defaults.data(); }
    PassImage create(const PassImageDesc&) override { return {next_++}; }
    History history(const PassImageDesc&) override { return {{next_++}, {next_++}}; }
    PassImage frame_image(FrameImage) override { return {next_++}; }
    bool has_frame_image(FrameImage) const override { return true; }
    bool is_depth_planar() const override { return true; }
    bool is_velocity_plain() const override { return true; }
    PassImage shadow_map(std::uint32_t) override { return {next_++}; }
    PassImage shared(std::string_view, PassImage (*make)(PassBuilder&), ConditionFunction) override {
        return make(*this);
    }
    PassImage table(const TableDesc&) override { return {next_++}; }
    PassImage add(const KernelPassDesc&) override {
        uses.has_passes = true;
        return {next_++};
    }
    std::vector<PassImage> add_all(const KernelPassDesc& desc) override {
        std::vector<PassImage> out{add(desc)};
        for (std::size_t i = 0; i < desc.more_outputs.size(); ++i) out.push_back({next_++});
        return out;
    }
    PassBuffer create_buffer(std::string_view, std::uint32_t) override { return {next_++}; }
    PassBuffer value(std::string_view, std::uint32_t) override { return {next_++}; }
    std::vector<PassImage> add_compute(const ComputePassDesc& desc) override {
        uses.has_passes = true;
        std::vector<PassImage> out(desc.outputs.size());
        for (PassImage& image : out) image = {next_++};
        return out;
    }
    void side(std::string, PassImage, PassVector) override {}
    void result(PassImage) override {}

  private:
    const EffectInfo& effect_;
    std::uint32_t next_ = 2;
};

}  // namespace

EffectUses uses_of(const EffectInfo& effect) {
    Listener listener(effect);
    if (effect.build) effect.build(listener);
    return listener.uses;
}

std::string_view purpose_of(const EffectInfo& effect) {
    constexpr std::string_view begin = "\nPurpose: ";
    for (const EffectFile& file : effect.files) {
        const std::size_t at = file.name.ends_with(".md") ? file.text.find(begin) : std::string_view::npos;
        if (at == std::string_view::npos) continue;
        const std::string_view rest = file.text.substr(at + begin.size());
        const auto found = std::ranges::find(purposes, rest.substr(0, rest.find('.')));
        return found == purposes.end() ? std::string_view() : *found;
    }
    return {};
}

}  // namespace darkroom::edit
