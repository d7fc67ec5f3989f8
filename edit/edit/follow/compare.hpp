// SPDX-License-Identifier: MIT
#pragma once
// When two looks are the same one.

#include <darkroom/look.hpp>

namespace darkroom::edit {

/// Do both have the same value of a row of their effect? Of a table the file's name counts.
[[nodiscard]] bool has_same(const LookEntry& a, const LookEntry& b, const ParamInfo& row);
/// Would files of them say the same? LookEntry::id, and what lies in the files that they name, do not count.
[[nodiscard]] bool says_same(const Look& a, const Look& b);
/// Is the look what was read of its text? What pulses and layers move is woken as it is read.
[[nodiscard]] bool reads_as(const Look& read, Look look);
/// The same, and what they have loaded is one.
[[nodiscard]] bool is_same(const Look& a, const Look& b);
/// Do all numbers agree, bit for bit?
[[nodiscard]] bool is_same(const ResourceData& a, const ResourceData& b);
/// Is one made of the same text as the other?
[[nodiscard]] bool is_same(const EffectInfo& a, const EffectInfo& b);
/// Bytes that a look takes, but for tables and pictures.
[[nodiscard]] std::size_t bytes_of(const Look& look);
/// And those of one of them.
[[nodiscard]] std::size_t bytes_of(const ResourceData& data);

}  // namespace darkroom::edit
