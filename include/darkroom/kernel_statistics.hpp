// SPDX-License-Identifier: MIT
#pragma once
// What a driver's compiler says of a kernel (VK_KHR_pipeline_executable_properties).

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace darkroom {

struct KernelStatistics {
    std::string name;                              ///< of the pass
    std::array<std::uint32_t, 2> workgroup{1, 1};  ///< 1x1 of a fragment shader
    std::uint32_t subgroup = 0;                    ///< threads that run in step
    struct Value {
        std::string name;
        double value = 0;
    };
    std::vector<Value> values;  ///< under the driver's own names and in its order
    std::string machine_code;   ///< as text; empty where the driver shows none

    /// 0: the driver has no such value.
    [[nodiscard]] double value(std::string_view value_name) const {
        for (const Value& one : values)
            if (one.name == value_name) return one.value;
        return 0;
    }
};

}  // namespace darkroom
