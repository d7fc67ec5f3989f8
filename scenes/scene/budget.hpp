// SPDX-License-Identifier: MIT
#pragma once
// What an input may become in memory, in proportion to the bytes of its files: a model with its buffers, or a scene
// with all that it names. Files may name one thing many times, so everything that can be multiplied is counted here
// before it is made. A model in memory and a moment of a scene are each held against a budget of their own.

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/try.hpp"

namespace darkroom::scene {

class Budget {
  public:
    /// What is free however small the files are, and what is added for each of their bytes. Bytes that are gone through
    /// are work, which is never given back.
    static constexpr std::uint64_t free_bytes = std::uint64_t{1} << 27, bytes_per_file_byte = 32;
    static constexpr std::uint64_t free_work = std::uint64_t{1} << 29, work_per_file_byte = 64;

    /// Draco and meshoptimizer make 5 to 10 of a byte of a real mesh.
    static constexpr std::uint64_t max_unpacked_per_byte = 12;

    /// `sharers`: so many inputs divide what is free among them.
    explicit Budget(std::uint64_t file_bytes = 0, std::uint64_t sharers = 1);
    /// A further file of the input.
    void add_file(std::uint64_t bytes);
    /// A part of the files that has been unpacked counts as if it had come so, though no more than 12 times, and no
    /// more often than there are bytes.
    void add_unpacked(std::uint64_t packed_bytes, std::uint64_t unpacked_bytes);
    [[nodiscard]] std::uint64_t file_bytes() const { return file_bytes_; }

    /// Room for `count` things of `size` bytes each. The error names the place, the count and the limit.
    [[nodiscard]] Result<> take(std::string_view place, std::string_view things, std::uint64_t count,
                                std::uint64_t size);
    /// What is gone through without being kept; take() counts as that, too.
    [[nodiscard]] Result<> work(std::string_view place, std::string_view things, std::uint64_t count,
                                std::uint64_t size);
    /// The first refusal, which callers may have taken for the fault of a part that can be left out.
    [[nodiscard]] Result<> check() const;

    /// For giving back what was taken for a time.
    [[nodiscard]] std::uint64_t taken() const { return memory_.taken; }
    void give_back_to(std::uint64_t taken) { memory_.taken = taken; }

  private:
    struct Account {
        std::uint64_t limit = 0, taken = 0;
    };
    [[nodiscard]] Result<> take_from(Account& account, std::string_view place, std::string_view things,
                                     std::uint64_t count, std::uint64_t size);

    std::uint64_t file_bytes_ = 0;
    std::uint64_t packed_ = 0, worth_ = 0;  ///< bytes that have been unpacked, and what they counted more for it
    Account memory_, work_;
    std::optional<Error> refusal_;
};

}  // namespace darkroom::scene
