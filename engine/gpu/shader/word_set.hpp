// SPDX-License-Identifier: MIT
#pragma once
// A few words for which every word of a text is looked up: nearly all others are told apart by first letter and length,
// and only the rest is hashed.

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <unordered_set>

namespace darkroom::gpu {

class WordSet {
  public:
    /// `word`: not empty, and kept by the caller.
    void insert(std::string_view word) {
        lengths_[place_of(word)] |= length_of(word);
        words_.insert(word);
    }
    [[nodiscard]] bool contains(std::string_view word) const {
        return (lengths_[place_of(word)] & length_of(word)) != 0 && words_.contains(word);
    }

  private:
    static std::size_t place_of(std::string_view word) { return static_cast<unsigned char>(word.front()); }
    static std::uint64_t length_of(std::string_view word) {
        return std::uint64_t{1} << std::min<std::size_t>(word.size(), 63);
    }

    std::array<std::uint64_t, 256> lengths_{};  ///< of the words that begin so
    std::unordered_set<std::string_view> words_;
};

}  // namespace darkroom::gpu
