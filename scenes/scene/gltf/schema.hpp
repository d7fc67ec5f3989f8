// SPDX-License-Identifier: MIT
#pragma once
// The shape that the JSON of a glTF file must have: which properties, of which types, which indices into which arrays.
// What passes here is safe to hand to the parsing library. It does not look at the data that accessors describe.

#include <darkroom/result.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "scene/budget.hpp"

namespace darkroom::scene::gltf {

/// What is wrong with the elements of a file, by JSON pointer of the element ("/meshes/3"). A faulty element is an
/// error only for what needs it; the others become warnings in the end. Texts begin with the pointer of the fault.
class Faults {
  public:
    void warn(std::string text);
    void add(const std::string& element, std::string text);
    /// An error if the element is faulty.
    [[nodiscard]] Result<> check(const std::string& element);
    /// All warnings, those of faults that nothing needed last.
    [[nodiscard]] std::vector<std::string> take_warnings();

  private:
    [[nodiscard]] bool contains(std::string_view text) const;

    std::map<std::string, std::string> faults_;
    std::vector<std::string> order_;
    std::vector<std::string> warnings_;
};

/// Removes what is not known here and replaces faulty elements of the arrays by harmless ones of the same index.
/// Errors: faults of the file as a whole, such as a required extension that is not read here, or more elements than the
/// budget has room for.
[[nodiscard]] Result<> check_structure(nlohmann::json& root, Faults& faults, Budget& budget);

}  // namespace darkroom::scene::gltf
