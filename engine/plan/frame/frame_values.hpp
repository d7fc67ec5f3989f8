// SPDX-License-Identifier: MIT
#pragma once
// What a program does in one frame: the values of its entries, which of them are on, what the picture is behind each,
// and which passes run. A function of the entries and the frame, worked out in storage that is made beforehand.

#include <memory>

#include "plan/frame/color.hpp"
#include "plan/program.hpp"

namespace darkroom::plan {

class FrameValues {
  public:
    FrameValues() = default;
    FrameValues(const Program& program, std::span<const Entry* const> entries);

    /// Allocates nothing. The entries are those that the program was planned from, in their order. `watched`: per
    /// watch, what the frame wants of it, or null.
    void evaluate(const Program& program, const CompileDesc& desc, std::span<const Entry* const> entries,
                  const PassContext& context, VkExtent2D target, std::span<const Watched* const> watched = {});

    /// The parameters of an entry, modulation and overrides included.
    [[nodiscard]] const std::uint32_t* words(std::uint32_t entry) const { return words_.data() + first_word_[entry]; }
    /// Does it change anything? What is left out never does.
    [[nodiscard]] bool is_on(std::uint32_t entry) const { return is_on_[entry] != 0; }
    [[nodiscard]] float opacity(std::uint32_t entry) const { return opacities_[entry]; }
    /// What the picture is that an entry gets, and that the target gets.
    [[nodiscard]] ColorState state_before(const Program& program, std::uint32_t entry) const {
        return state_behind(program.entry_states[entry]);
    }
    [[nodiscard]] ColorState state_after(std::uint32_t entry) const { return states_[entry]; }
    [[nodiscard]] ColorState last_state(const Program& program) const { return state_behind(program.last_entry); }
    /// How a step of this entry that may need it gets the picture.
    [[nodiscard]] const Work& work(std::uint32_t entry) const { return works_[entry]; }
    [[nodiscard]] const Conversion& finish() const { return finish_; }
    /// Of the frame's camera, see glsl.hpp.
    [[nodiscard]] bool rays_meet() const { return rays_meet_; }
    /// Is it left out of this frame alone? Its camera has no perspective, which the effect needs.
    [[nodiscard]] bool lacks_perspective(const EffectInfo& info) const {
        return info.needs.perspective && !has_perspective_;
    }
    [[nodiscard]] const graph::Extents& extents() const { return extents_; }
    [[nodiscard]] std::span<const bool> gates() const { return {gates_.get(), gate_count_}; }

  private:
    [[nodiscard]] ColorState state_behind(std::uint32_t entry) const {
        return entry == no_entry ? scene_ : entry == ui_entry ? srgb_color : states_[entry];
    }
    [[nodiscard]] bool is_open(const Program& program, const Gate& gate, const PassContext& context,
                               std::span<const Watched* const> watched) const;

    std::vector<std::uint32_t> words_, first_word_;
    std::vector<std::uint8_t> is_on_;
    std::vector<float> opacities_;
    std::vector<ColorState> states_;  ///< behind each entry; one that an earlier entry reads is the last frame's
    std::vector<Work> works_;
    ColorState scene_;
    Conversion finish_;
    bool rays_meet_ = false, has_perspective_ = false;
    graph::Extents extents_;
    std::unique_ptr<bool[]> gates_;
    std::size_t gate_count_ = 0;
};

/// What is expected of frames before there are any: one with perspective.
[[nodiscard]] Camera example_camera();
/// Of a frame that brings all that `desc` promises, and a light to look at.
[[nodiscard]] FrameValues example_values(const Program& program, const CompileDesc& desc,
                                         std::span<const Entry* const> entries);

/// describe_program() with the values of a frame.
[[nodiscard]] Plan describe_frame(const Program& program, const graph::Compiled& compiled, const CompileDesc& desc,
                                  std::span<const Entry* const> entries, const FrameValues& values);

}  // namespace darkroom::plan
