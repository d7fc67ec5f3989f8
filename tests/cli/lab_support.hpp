// SPDX-License-Identifier: MIT
#pragma once
// Tests of darkroom_lab.

#include "tests/cli/cli_support.hpp"

namespace darkroom::test {

/// A fixture by which the commands of darkroom_lab are run as those of darkroom are.
template <class Fixture>
class WithLab : public Fixture {
  protected:
    [[nodiscard]] Outcome run(const std::vector<std::string>& arguments) const {
        const std::vector<std::string> of_lab{"api", "capture", "judge"};
        if (std::ranges::find(of_lab, arguments.front()) == of_lab.end()) return Fixture::run(arguments);
        std::string line = "darkroom_lab";
        for (const std::string& argument : arguments) line.append(1, ' ').append(quoted(argument));
        return this->run_lines(line);
    }
    void expect_refused(const std::vector<std::string>& arguments, int code, const std::string& part) const {
        const std::vector<std::string> before = this->files();
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, code) << outcome.err;
        EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
        EXPECT_TRUE(outcome.err.starts_with("darkroom: ")) << outcome.err;
        EXPECT_NE(outcome.err.find(part), std::string::npos) << part << " is not in " << outcome.err;
        EXPECT_EQ(this->files(), before);
    }
};

}  // namespace darkroom::test
