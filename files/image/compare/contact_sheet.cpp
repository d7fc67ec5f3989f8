// SPDX-License-Identifier: MIT
#include "image/compare/contact_sheet.hpp"

#include <algorithm>
#include <utility>

#include "image/compare/shown_picture.hpp"

namespace darkroom {

namespace {

constexpr std::uint32_t gap = 8;
constexpr std::array<float, 4> background{0.12f, 0.12f, 0.12f, 1.0f};

}  // namespace

Result<> ContactSheet::add(std::string name, const Picture& reference, const Picture& test,
                           const Comparison& comparison, PictureEncoding encoding) {
    Row row{.name = std::move(name),
            .non_finite = comparison.non_finite_differences + comparison.alpha.non_finite_differences,
            .flip = comparison.flip_mean};
    const auto place = std::ranges::find_if(rows_, [&](const Row& other) { return row.is_worse_than(other); });
    if (place == rows_.end() && rows_.size() == max_rows) return {};
    const std::array<std::pair<const Picture*, PictureEncoding>, 3> pictures{
        {{&reference, encoding}, {&test, encoding}, {&comparison.flip_map, PictureEncoding::Display}}};
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        DARKROOM_TRY_VALUE(Picture made,
                           no_larger_than(shown_picture(*pictures[i].first, pictures[i].second), max_cell));
        row.cells[i] = std::move(made);
    }
    rows_.insert(place, std::move(row));
    if (rows_.size() > max_rows) rows_.pop_back();
    return {};
}

Picture ContactSheet::picture() const {
    std::uint32_t width = 0, height = gap;
    for (const Row& row : rows_) {
        width = std::max(width, row.cells[0].width);
        height += row.cells[0].height + gap;
    }
    Picture sheet(rows_.empty() ? 1 : 3 * width + 4 * gap, rows_.empty() ? 1 : height);
    for (std::size_t i = 0; i < sheet.pixels.size(); ++i) sheet.pixels[i] = background[i % 4];
    std::uint32_t top = gap;
    for (const Row& row : rows_) {
        for (std::uint32_t i = 0; i < 3; ++i)
            for (std::uint32_t y = 0; y < row.cells[i].height; ++y)
                std::copy_n(row.cells[i].at(0, y), std::size_t{row.cells[i].width} * 4,
                            sheet.at(gap + i * (width + gap), top + y));
        top += row.cells[0].height + gap;
    }
    return sheet;
}

std::vector<std::string> ContactSheet::names() const {
    std::vector<std::string> names;
    for (const Row& row : rows_) names.push_back(row.name);
    return names;
}

}  // namespace darkroom
