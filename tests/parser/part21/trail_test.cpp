// Cycles and long chains of references; numbers in brackets are those of the contract in trail.h.

#include "parser/part21/trail.h"

#include <functional>

#include "parser/part21/step_text.h"

namespace lyr::part21 {
namespace {

// Follows all references from `start`; "" or the error met.
std::string follow(const File& file, Trail& trail, InstanceIndex start) {
    auto step = trail.enter(start);
    if (!step) return to_string(step.error());
    const auto arguments = file.arguments(start);
    REQUIRE(arguments.ok());
    for (std::size_t i = 0; i < arguments->count(); ++i) {
        const auto next = (*arguments)[i].as_reference();
        REQUIRE(next.ok());
        const std::string error = follow(file, trail, *next);
        if (!error.empty()) return error;
    }
    return "";
}

TEST_CASE("a cycle is an error that spells it out [1]") {
    const File file = with_instances("#1=A(#5);\n#5=B(#7);\n#7=C(#9,#5);\n#9=D();\n#2=A(#2);");
    Trail trail(file);
    CHECK(follow(file, trail, file.find(1)) ==
          "test.stp:9:1: error: #5: #5 refers to itself: #5 -> #7 -> #5");
    CHECK(follow(file, trail, file.find(2)) ==
          "test.stp:12:1: error: #2: #2 refers to itself: #2 -> #2");
}

TEST_CASE("a long cycle is shortened [1]") {
    std::string text;
    for (int i = 1; i <= 50; ++i)
        text += '#' + std::to_string(i) + "=A(#" + std::to_string(i % 50 + 1) + ");\n";
    const File file = with_instances(text);
    Trail trail(file);
    CHECK(follow(file, trail, file.find(1)) ==
          "test.stp:8:1: error: #1: #1 refers to itself: #1 -> #2 -> #3 -> #4 -> #5 -> #6 -> #7 -> "
          "#8 -> #9 -> ... "
          "-> #1");
}

TEST_CASE("an instance may be reached twice by different ways [1]") {
    const File file = with_instances("#1=A(#2,#3);\n#2=B(#4);\n#3=B(#4);\n#4=C();");
    Trail trail(file);
    CHECK(follow(file, trail, file.find(1)) == "");
    CHECK(follow(file, trail, file.find(1)) == "");
}

TEST_CASE("an endless chain is an error and not the end of the stack [2]") {
    std::string text;
    for (int i = 1; i <= 100000; ++i)
        text += '#' + std::to_string(i) + "=A(#" + std::to_string(i + 1) + ");\n";
    const File file = with_instances(text + "#100001=B();");
    Trail trail(file);
    CHECK(follow(file, trail, file.find(1)) ==
          "test.stp:1008:1: error: #1001: this instance is reached by more than 1000 references in "
          "a row");
    CHECK(follow(file, trail, file.find(100001 - 999)) == "");
}

}  // namespace
}  // namespace lyr::part21
