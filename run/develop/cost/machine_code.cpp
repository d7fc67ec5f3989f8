// SPDX-License-Identifier: MIT
#include "develop/cost/machine_code.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace darkroom {

namespace {

std::string_view trimmed(std::string_view text) {
    const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
    return text;
}

/// Cuts `text` at the first `separator`, and takes what was before it.
std::string_view take_until(std::string_view& text, char separator) {
    const std::size_t at = text.find(separator);
    const std::string_view out = text.substr(0, at);
    text = at == std::string_view::npos ? std::string_view() : text.substr(at + 1);
    return out;
}

std::optional<std::int32_t> literal(std::string_view text) {
    const bool is_hexadecimal = text.starts_with("0x");
    if (is_hexadecimal) text.remove_prefix(2);
    std::int64_t value = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value, is_hexadecimal ? 16 : 10);
    if (error != std::errc() || stop != end) return {};
    return static_cast<std::int32_t>(value);
}

/// The scalar registers whose values are known, and the result of the last comparison.
class Scalars {
  public:
    void run(const MachineCode::Instruction& instruction);
    [[nodiscard]] std::optional<bool> condition() const { return condition_; }

  private:
    [[nodiscard]] std::optional<std::int32_t> value(std::string_view operand) const {
        const auto found = registers_.find(operand);
        return found == registers_.end() ? literal(operand) : found->second;
    }
    void forget(std::string_view operand);
    void compare(std::string_view comparison, std::string_view left, std::string_view right);
    [[nodiscard]] std::optional<std::int32_t> result(const MachineCode::Instruction& instruction) const;

    std::map<std::string_view, std::int32_t> registers_;
    std::optional<bool> condition_;
};

/// "s12", or the registers of "s[8:11]".
void Scalars::forget(std::string_view operand) {
    if (!operand.starts_with("s[")) {
        registers_.erase(operand);
        return;
    }
    std::string_view range = operand.substr(2, operand.size() - 3);
    const auto first = literal(take_until(range, ':')), last = literal(range);
    std::erase_if(registers_, [&](const auto& one) {
        const auto number = literal(one.first.substr(1));
        return number && first && last && *first <= *number && *number <= *last;
    });
}

void Scalars::compare(std::string_view comparison, std::string_view left, std::string_view right) {
    condition_.reset();
    const auto a = value(left), b = value(right);
    if (!a || !b) return;
    const bool is_unsigned = comparison.ends_with("_u32");
    if (!is_unsigned && !comparison.ends_with("_i32")) return;
    const auto order = is_unsigned ? static_cast<std::uint32_t>(*a) <=> static_cast<std::uint32_t>(*b) : *a <=> *b;
    const std::string_view kind = comparison.substr(0, 2);
    condition_ = (kind == "lt" && order < 0) || (kind == "le" && order <= 0) || (kind == "gt" && order > 0) ||
                 (kind == "ge" && order >= 0) || (kind == "eq" && order == 0) || (kind == "lg" && order != 0);
}

std::optional<std::int32_t> Scalars::result(const MachineCode::Instruction& instruction) const {
    const auto& [name, operands] = instruction;
    if (operands.size() == 2) {
        const auto from = value(operands[1]), old = value(operands[0]);
        if (name == "s_mov_b32" || name == "s_movk_i32") return from;
        if (name == "s_addk_i32" && from && old) return *old + *from;
    } else if (operands.size() == 3) {
        const auto a = value(operands[1]), b = value(operands[2]);
        if (!a || !b) return {};
        if (name == "s_add_i32" || name == "s_add_u32") return *a + *b;
        if (name == "s_sub_i32" || name == "s_sub_u32") return *a - *b;
        if (name == "s_min_i32") return std::min(*a, *b);
        if (name == "s_max_i32") return std::max(*a, *b);
    }
    return {};
}

void Scalars::run(const MachineCode::Instruction& instruction) {
    const auto& [name, operands] = instruction;
    if (name.starts_with("s_cmp_") && operands.size() == 2) return compare(name.substr(6), operands[0], operands[1]);
    if (name.starts_with("s_cmpk_") && operands.size() == 2) return compare(name.substr(7), operands[0], operands[1]);
    if (name.starts_with("s_cbranch") || name == "s_branch") return;
    // These alone leave the condition as it is.
    const bool keeps = !name.starts_with("s_") || name.starts_with("s_mov") || name.starts_with("s_load") ||
                       name.starts_with("s_buffer_load") || name.starts_with("s_waitcnt") || name == "s_clause";
    if (!keeps) condition_.reset();
    if (operands.empty()) return;
    const auto made = result(instruction);
    forget(operands[0]);
    if (made) registers_[operands[0]] = *made;
}

}  // namespace

MachineCode::MachineCode(std::string_view text) {
    std::vector<std::pair<std::size_t, std::size_t>> backward;  // target and branch
    while (!text.empty()) {
        std::string_view line = take_until(text, '\n');
        line = trimmed(take_until(line, ';'));
        if (line.starts_with("BB") && line.ends_with(':'))
            blocks_[line.substr(0, line.size() - 1)] = instructions_.size();
        if (line.empty() || line.ends_with(':') || std::islower(static_cast<unsigned char>(line[0])) == 0) continue;
        Instruction one{.name = take_until(line, ' ')};
        for (line = trimmed(line); !line.empty();) one.operands.push_back(trimmed(take_until(line, ',')));
        const bool is_branch = one.name == "s_branch" || one.name.starts_with("s_cbranch");
        const auto target = is_branch && !one.operands.empty() ? blocks_.find(one.operands[0]) : blocks_.end();
        if (target != blocks_.end()) backward.emplace_back(target->second, instructions_.size());
        instructions_.push_back(std::move(one));
    }
    std::ranges::sort(backward);
    for (const auto& [begin, end] : backward) {
        if (loops_.empty() || loops_.back().begin != begin) loops_.push_back({begin, end});
        loops_.back().end = end;
    }
}

std::optional<std::uint32_t> MachineCode::trips(const Loop& loop) const {
    // Far more than a loop of literals has: 256 rounds of a body of 400 instructions.
    constexpr std::uint32_t max_steps = 100000;
    Scalars scalars;
    for (std::size_t i = 0; i < loop.begin; ++i) scalars.run(instructions_[i]);
    std::uint32_t rounds = 0;
    std::size_t at = loop.begin;
    for (std::uint32_t step = 0; step < max_steps; ++step) {
        const Instruction& one = instructions_[at];
        scalars.run(one);
        std::optional<bool> is_taken = one.name == "s_branch";
        if (one.name.starts_with("s_cbranch_")) {
            is_taken.reset();
            if (const auto condition = scalars.condition(); condition && one.name.starts_with("s_cbranch_scc"))
                is_taken = *condition == one.name.ends_with('1');
        }
        const bool is_last = at == loop.end;
        if (is_last && !is_taken) return {};
        const bool jumps = is_taken.value_or(false) && !one.operands.empty();
        const auto target = jumps ? blocks_.find(one.operands[0]) : blocks_.end();
        at = target == blocks_.end() ? at + 1 : target->second;
        if (at == loop.begin) ++rounds;
        if (at < loop.begin || at > loop.end) return rounds + (is_last ? 1U : 0U);
    }
    return {};
}

}  // namespace darkroom
