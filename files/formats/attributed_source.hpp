// SPDX-License-Identifier: MIT
#pragma once
// A picture of one part whose attributes are single numbers: what PNG, JPEG and plain TIFF have.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/text/lower.hpp"
#include "formats/picture_source.hpp"

namespace darkroom {

class AttributedSource : public PictureSource {
  public:
    [[nodiscard]] std::vector<double> numbers(std::size_t /*part*/, std::string_view attribute) const override {
        for (const auto& [name, number] : attributes_)
            if (lower(name) == lower(attribute)) return {number};
        return {};
    }
    [[nodiscard]] std::vector<std::string> attributes(std::size_t /*part*/) const override {
        std::vector<std::string> out;
        for (const auto& attribute : attributes_) out.push_back(attribute.first);
        return out;
    }

  protected:
    std::vector<std::pair<std::string, double>> attributes_;
};

}  // namespace darkroom
