// SPDX-License-Identifier: MIT
#pragma once
// Which entries and passes are on: for a frame's values while recording, and for the present ones in a plan.

#include <memory>
#include <span>
#include <vector>

#include "plan/program.hpp"

namespace darkroom::plan {

/// Room for the values of a stack and for what follows from them, made once: evaluating allocates nothing.
class Gates {
  public:
    Gates() = default;
    Gates(const Program& program, std::span<const Entry> stack);

    void evaluate(const Program& program, std::span<const Entry> stack, const PassContext& context);

    [[nodiscard]] bool is_on(std::uint32_t entry) const { return is_on_[entry]; }
    [[nodiscard]] Domain domain_behind(std::uint32_t entry) const {
        return entry == no_entry ? Domain::SceneLinear : domains_[entry];
    }
    /// As Schedule::derive takes them.
    [[nodiscard]] std::span<const bool> toggles() const { return {toggles_.get(), toggle_count_}; }
    /// The values of an entry, under its overrides.
    [[nodiscard]] const std::uint32_t* words_of(std::uint32_t entry) const { return words_.data() + words_at_[entry]; }

  private:
    std::vector<std::uint32_t> words_, words_at_;
    std::unique_ptr<bool[]> is_on_, toggles_;
    std::vector<Domain> domains_;  ///< behind each entry
    std::size_t toggle_count_ = 0;
};

}  // namespace darkroom::plan
