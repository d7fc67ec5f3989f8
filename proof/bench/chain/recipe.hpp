// SPDX-License-Identifier: MIT
#pragma once
// A row by its name, before it is made: rows are many, and a run asks for some.

#include <functional>
#include <string>

#include "bench/measure.hpp"

namespace darkroom::bench {

struct Recipe {
    std::string name;
    /// A row without work is dropped: what it would measure is not there, and `make` has said so.
    std::function<Result<Row>(Bed&, const std::string& name)> make;
};

}  // namespace darkroom::bench
