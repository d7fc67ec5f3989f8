// SPDX-License-Identifier: MIT
#pragma once
// What a header of OpenEXR says, read without the library, which allocates what a header asks for. The layout is that
// of "OpenEXR File Layout" (Academy Software Foundation): little-endian, attributes by name.

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/try.hpp"

namespace darkroom::exr {

using Wide = long long;

class Reader {
  public:
    Reader(std::span<const std::byte> bytes, std::size_t position = 0) : bytes_(bytes), position_(position) {}

    [[nodiscard]] std::size_t position() const { return position_; }
    [[nodiscard]] std::size_t left() const { return bytes_.size() - position_; }
    [[nodiscard]] bool is_past_end() const { return is_past_end_; }

    template <class T>
    T number() {
        T value{};
        if (left() < sizeof(T)) return fail<T>();
        std::memcpy(&value, bytes_.data() + position_, sizeof(T));
        position_ += sizeof(T);
        return value;
    }
    std::string_view text() {
        const auto* begin = reinterpret_cast<const char*>(bytes_.data()) + position_;
        const auto* end = static_cast<const char*>(left() == 0 ? nullptr : std::memchr(begin, 0, left()));
        if (end == nullptr) return fail<std::string_view>();
        position_ += static_cast<std::size_t>(end - begin) + 1;
        return {begin, static_cast<std::size_t>(end - begin)};
    }
    std::span<const std::byte> block(Wide size) {
        if (size < 0 || static_cast<std::size_t>(size) > left()) return fail<std::span<const std::byte>>();
        position_ += static_cast<std::size_t>(size);
        return bytes_.subspan(position_ - static_cast<std::size_t>(size), static_cast<std::size_t>(size));
    }

  private:
    template <class T>
    T fail() {
        is_past_end_ = true;
        position_ = bytes_.size();
        return T{};
    }

    std::span<const std::byte> bytes_;
    std::size_t position_ = 0;
    bool is_past_end_ = false;
};

struct Window {
    Wide left = 0, top = 0, right = 0, bottom = 0;
    [[nodiscard]] Wide width() const { return right - left + 1; }
    [[nodiscard]] Wide height() const { return bottom - top + 1; }
    [[nodiscard]] std::string text() const { return fmt::format("{}x{}", width(), height()); }
};

struct Tiles {
    Wide width = 0, height = 0;
    unsigned level_mode = 0;  // 0 one level, 1 mip-mapped, 2 rip-mapped
    bool rounds_up = false;
};

struct AttributeCount {
    std::size_t number = 0, bytes = 0;
};

struct CheckedPart {
    std::optional<Window> data;
    std::optional<Window> display;
    std::optional<Tiles> tiles;
    std::optional<unsigned> compression;
    std::string type, name;
    double bytes_per_pixel = 0;  // subsampled channels have fewer than one sample a pixel
    Wide bytes = 0;              // of all pixels, at full resolution
    Wide channel_count = 0;
    Wide chunk_count = 0;
};

[[nodiscard]] Failure malformed(std::string_view what);
[[nodiscard]] Failure cut_off();

/// One part's header. `count` is that of all parts so far.
[[nodiscard]] Result<> read_part(Reader& reader, CheckedPart& part, AttributeCount& count);

}  // namespace darkroom::exr
