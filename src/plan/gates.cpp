// SPDX-License-Identifier: MIT
#include "plan/gates.hpp"

namespace darkroom::plan {

Gates::Gates(const Program& program, std::span<const Entry> stack) : toggle_count_(program.toggles.size()) {
    std::uint32_t words = 0;
    for (const Entry& entry : stack) {
        words_at_.push_back(words);
        words += static_cast<std::uint32_t>(entry.info->parameters.words());
    }
    words_.resize(words + 1);
    domains_.resize(stack.size());
    is_on_ = std::make_unique<bool[]>(stack.size() + 1);
    toggles_ = std::make_unique<bool[]>(toggle_count_ + 1);
}

void Gates::evaluate(const Program& program, std::span<const Entry> stack, const PassContext& context) {
    for (std::size_t i = 0; i < stack.size(); ++i) {
        std::uint32_t* const words = words_.data() + words_at_[i];
        stack[i].evaluate({words, stack[i].info->parameters.words()});
        is_on_[i] = !program.is_left_out[i] && stack[i].is_on(words);
        domains_[i] = stack[i].domain_after(domain_behind(program.entry_inputs[i]), words, is_on_[i]);
    }
    for (std::size_t i = 0; i < toggle_count_; ++i) {
        const Gate& gate = program.toggles[i];
        const auto holds = [&](std::uint32_t entry, ConditionFunction condition) {
            if (condition == nullptr) return true;
            PassContext own = context;
            own.frame_extent = program.entry_sizes[entry].of(context.frame_extent);
            return condition(words_of(entry), own, gate.argument);
        };
        bool is_on = false;
        for (std::size_t e = 0; e < gate.entries.size(); ++e) {
            const std::uint32_t entry = gate.entries[e];
            is_on = is_on || (is_on_[entry] && (gate.conditions.empty() || holds(entry, gate.conditions[e])));
        }
        toggles_[i] = is_on && holds(gate.entries.front(), gate.condition);
    }
}

}  // namespace darkroom::plan
