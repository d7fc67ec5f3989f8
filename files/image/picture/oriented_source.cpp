// SPDX-License-Identifier: MIT
#include "image/picture/oriented_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace darkroom {
namespace {

// Where what is shown at (x, y) is stored, of a stored picture of this size (EXIF 2.32, 4.6.4, Orientation).
struct Place {
    std::uint32_t x = 0, y = 0;
};
Place stored_place(int orientation, std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height) {
    switch (orientation) {
        case 2:
            return {width - 1 - x, y};
        case 3:
            return {width - 1 - x, height - 1 - y};
        case 4:
            return {x, height - 1 - y};
        case 5:
            return {y, x};
        case 6:
            return {y, height - 1 - x};
        case 7:
            return {width - 1 - y, height - 1 - x};
        case 8:
            return {width - 1 - y, x};
        default:
            return {x, y};
    }
}

class OrientedSource final : public PictureSource {
  public:
    OrientedSource(std::unique_ptr<PictureSource> stored, int orientation)
        : stored_(std::move(stored)), orientation_(orientation) {
        parts_.assign(stored_->parts().begin(), stored_->parts().end());
        if (orientation < 5) return;
        std::swap(parts_[0].width, parts_[0].height);
        std::swap(parts_[0].display_width, parts_[0].display_height);
    }

    std::vector<double> numbers(std::size_t part, std::string_view attribute) const override {
        return stored_->numbers(part, attribute);
    }
    std::vector<std::string> attributes(std::size_t part) const override { return stored_->attributes(part); }
    std::uint32_t row_unit(std::size_t /*part*/) const override { return 1; }

  private:
    /// The last row may be the first that is asked for, so all of it is decoded with the first rows, and kept.
    Result<> decode(std::span<const SamplePlace> places) {
        const FilePart& stored = stored_->parts()[0];
        kind_ = places.front().kind;
        channels_.clear();
        for (const SamplePlace& place : places) channels_.push_back(place.channel);
        const std::size_t pixel = size_of(kind_) * channels_.size(), row = pixel * stored.width;
        samples_.resize(row * stored.height);
        const std::uint32_t unit = stored_->row_unit(0), band = std::max(unit, 64 / unit * unit);
        for (std::uint32_t first = 0; first < stored.height; first += band) {
            std::vector<SamplePlace> to;
            for (std::size_t i = 0; i < channels_.size(); ++i)
                to.push_back({.channel = channels_[i],
                              .kind = kind_,
                              .first = samples_.data() + first * row + i * size_of(kind_),
                              .pixel_bytes = static_cast<std::ptrdiff_t>(pixel),
                              .row_bytes = static_cast<std::ptrdiff_t>(row)});
            if (auto done = stored_->read_rows(0, first, std::min(band, stored.height - first), to); !done) {
                channels_.clear();
                return done;
            }
        }
        return {};
    }

    Result<> read(std::size_t /*part*/, std::uint32_t row, std::uint32_t rows,
                  std::span<const SamplePlace> places) override {
        const bool is_kept =
            kind_ == places.front().kind && std::ranges::equal(channels_, places, {}, {}, &SamplePlace::channel);
        if (!is_kept) DARKROOM_TRY(decode(places));
        const FilePart& stored = stored_->parts()[0];
        const std::size_t size = size_of(kind_);
        for (std::uint32_t y = 0; y < rows; ++y)
            for (std::uint32_t x = 0; x < parts_[0].width; ++x) {
                const Place at = stored_place(orientation_, x, row + y, stored.width, stored.height);
                const std::byte* const from =
                    samples_.data() + (std::size_t{at.y} * stored.width + at.x) * size * channels_.size();
                for (std::size_t i = 0; i < places.size(); ++i)
                    std::memcpy(places[i].first + static_cast<std::ptrdiff_t>(y) * places[i].row_bytes +
                                    static_cast<std::ptrdiff_t>(x) * places[i].pixel_bytes,
                                from + i * size, size);
            }
        return {};
    }

    std::unique_ptr<PictureSource> stored_;
    int orientation_ = 1;
    SampleKind kind_ = SampleKind::Float;
    std::vector<std::size_t> channels_;  // of what is kept
    std::vector<std::byte> samples_;
};

}  // namespace

Result<int> orientation_of(const OpenedSource& opened, std::span<const std::byte> bytes) {
    if (opened.format->orientation != nullptr) return opened.format->orientation(bytes, *opened.source);
    // Another number than these stands in files, and is taken as upright by all who show them.
    const std::vector<double> found = opened.source->numbers(0, "Orientation");
    return found.size() == 1 && found[0] >= 1 && found[0] <= 8 ? static_cast<int>(found[0]) : 1;
}

Result<OpenedSource> open_upright(std::span<const std::byte> bytes, std::size_t max_threads, DecodingPlace place) {
    DARKROOM_TRY_VALUE(OpenedSource opened, open_source(bytes, max_threads, place));
    DARKROOM_TRY_VALUE(const int orientation, orientation_of(opened, bytes));
    if (orientation != 1) opened.source = std::make_unique<OrientedSource>(std::move(opened.source), orientation);
    return opened;
}

}  // namespace darkroom
