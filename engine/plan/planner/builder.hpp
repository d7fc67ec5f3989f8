// SPDX-License-Identifier: MIT
#pragma once
// Declares the passes of one entry, for planner*.cpp and builder*.cpp only.

#include <utility>

#include "plan/planner/planner_state.hpp"

namespace darkroom::plan {

/// What an effect's build() sees.
class Builder final : public PassBuilder {
  public:
    struct Side {
        std::string name;
        PassInput input;
    };

    Builder(Planner& planner, std::uint32_t entry, std::size_t input)
        : planner_(planner), entry_(entry), input_(input), values_(planner.stack_[entry].values_at_compile()) {}

    [[nodiscard]] PassImage picture() override;
    [[nodiscard]] PassImage source() override;
    [[nodiscard]] std::uint32_t from_max_extent(std::uint32_t (*question)(VkExtent2D)) override;
    [[nodiscard]] const void* parameters() const override { return values_.data(); }
    [[nodiscard]] const ResourceData* resource(Resource resource) const override {
        return find_resource(planner_.stack_[entry_].resources.get(), resource);
    }
    [[nodiscard]] PassImage create(const PassImageDesc& desc) override;
    [[nodiscard]] bool is_stored(VkFormat format) const override;
    [[nodiscard]] History history(const PassImageDesc& desc) override;
    [[nodiscard]] PassImage frame_image(FrameImage which) override;
    [[nodiscard]] bool has_frame_image(FrameImage which) const override;
    [[nodiscard]] bool is_depth_planar() const override { return planner_.desc_.is_depth_planar; }
    [[nodiscard]] bool is_velocity_plain() const override { return planner_.desc_.is_velocity_plain; }
    [[nodiscard]] PassImage shadow_map(std::uint32_t number) override;
    [[nodiscard]] PassImage shared(std::string_view name, PassImage (*make)(PassBuilder&),
                                   ConditionFunction condition) override;
    [[nodiscard]] PassImage table(const TableDesc& desc) override;
    PassImage add(const KernelPassDesc& desc) override {
        const std::vector<PassImage> all = add_all(desc);
        return all.empty() ? PassImage{} : all.front();
    }
    std::vector<PassImage> add_all(const KernelPassDesc& desc) override;
    [[nodiscard]] ComputeLimits compute_limits() const override { return planner_.traits_.compute; }
    [[nodiscard]] bool is_written(VkFormat format) const override;
    [[nodiscard]] bool tiles_pay(VkFormat format, const ComputeLimits& asked) override;
    [[nodiscard]] PassBuffer create_buffer(std::string_view name, std::uint32_t bytes) override;
    [[nodiscard]] PassBuffer value(std::string_view name, std::uint32_t numbers) override;
    [[nodiscard]] PassBuffer find_value(std::string_view name) const override;
    std::vector<PassImage> add_compute(const ComputePassDesc& desc) override;
    void value_side(std::string name, PassBuffer value) override;
    void side(std::string name, PassImage image, PassVector neutral) override;
    void end_constants(std::uint32_t vectors, ConstantsFunction constants) override {
        end_vectors = vectors;
        end_function = constants;
    }
    void result(PassImage image) override;

    std::uint32_t end_vectors = 0;
    ConstantsFunction end_function = nullptr;
    std::vector<Side> sides;
    graph::Version output;
    std::string error;

  private:
    struct Image {
        graph::Version version;
        graph::Version first_written;  ///< falls back to the neutral image, if it has one
        VkFormat format = VK_FORMAT_UNDEFINED;
        std::uint32_t table = no_table;
        bool is_shadow_map = false;
        std::int32_t shared_toggle = -1;
    };
    [[nodiscard]] graph::ImageDesc image_desc(const PassImageDesc& desc) const;
    [[nodiscard]] PassImage remember_new(graph::Version version, const graph::ImageDesc& desc);
    [[nodiscard]] PassInput input_of(const Image& image, std::uint32_t mip_level) const;
    [[nodiscard]] PassImage remember(Image image);
    /// What the image is behind a pass that made this version of it.
    [[nodiscard]] PassImage remember_written(PassImage image, graph::Version version);
    /// Says so in `error`, and returns false, if the outputs cannot be written by one pass.
    [[nodiscard]] bool check_outputs(const KernelPassDesc& desc);
    [[nodiscard]] bool check_compute(const ComputePassDesc& desc);
    void add_input(ProgramPass& pass, FusedStep& step, const KernelPassDesc::Input& input);
    /// Sets `error` and returns false if it is not a value.
    [[nodiscard]] bool check_value(std::string_view reader, const std::string& name, PassBuffer value);
    [[nodiscard]] bool add_values(ProgramPass& pass, FusedStep& step, const KernelPassDesc& desc);
    /// Its text, its members and its gate.
    [[nodiscard]] bool finish_pass(ProgramPass& pass, FusedStep& step, std::string_view shader, const Gate& gate,
                                   std::span<const KernelPassDesc::Input> inputs);
    [[nodiscard]] PassImage image_of(std::size_t value);
    [[nodiscard]] PassImage at_own_size(Result<graph::Version> version);

    Planner& planner_;
    std::uint32_t entry_ = 0;
    std::size_t input_ = 0;
    std::vector<std::uint32_t> values_;
    std::uint32_t value_count_ = 0;  ///< that the entry made so far
    std::vector<Image> images_;
    std::int32_t shared_toggle_ = -1;         ///< of the passes that `shared` is declaring
    std::vector<std::int32_t> shared_needs_;  ///< asked for since the innermost `shared` began
};

}  // namespace darkroom::plan
