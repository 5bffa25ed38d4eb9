// What is wrong with a file, and where; numbers in brackets are those of the contract in part21.h.

#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "parser/part21/step_text.h"
#include "scratch.h"

namespace lyr::part21 {
namespace {

TEST_CASE("errors in the DATA section: place, #id, expected, found [2]") {
    const std::pair<const char*, const char*> cases[] = {
        {"#1=A(1)\n#2=B();", "9:1: error: #1: expected ';' at the end of an instance, found '#2'"},
        {"#1=A(1;\n#2=B();", "8:7: error: #1: expected ',' or ')', found ';'"},
        {"#1=A(1,\n#2=B();", "9:3: error: #1: expected ',' or ')', found '='"},
        {"#1=A(1));", "8:8: error: #1: expected ';' at the end of an instance, found ')'"},
        {"#1 A();", "8:4: error: #1: expected '=' after the name of an instance, found 'A'"},
        {"#1=;", "8:4: error: #1: expected a keyword, found ';'"},
        {"#1=A;", "8:5: error: #1: expected '(' after A, found ';'"},
        {"#1=5(1);", "8:4: error: #1: expected a keyword, found '5'"},
        {"#=A();", "8:2: error: expected a number after #, found '='"},
        {"#x=A();", "8:2: error: expected a number after #, found 'x'"},
        {"A();", "8:1: error: expected an instance (#1=...) or ENDSEC;, found 'A'"},
        {"@1=A();", "8:1: error: expected an instance (#1=...) or ENDSEC;, found '@1'"},
        {"#1=A();;", "8:8: error: expected an instance (#1=...) or ENDSEC;, found ';'"},
        {"#1=A(\x01);", "8:6: error: #1: A argument 1: expected a value, found the byte 0x01"},
        {"#18446744073709551616=A();",
         "8:1: error: the number of this instance name is beyond 64 bits"},
        {"#1=A();\n #2=B();\n  #1=C();",
         "10:3: error: #1: this instance name is defined twice, first in line 8; expected each #id "
         "once"},
        {"#1=();", "8:5: error: #1: expected a keyword, found ')'"},
        {"#1=(A());\n#2=(A()", "10:7: error: #2: expected '(' after ENDSEC, found ';'"},
        {"#1=(A(),B());", "8:8: error: #1: expected a keyword, found ','"},
        {"#1=A(/ 2);", "8:6: error: #1: expected ',' or ')', found '/'"},
        {"ENDSCOPE;", "8:9: error: ENDSCOPE without &SCOPE before it"},
        {"#1=&SCOPE\n#2=A();",
         "10:1: error: expected an instance (#1=...) or ENDSCOPE, found 'ENDSEC'"},
        {"#1=&COPE", "8:5: error: #1: expected SCOPE after &, found 'COPE'"},
    };
    for (const auto& [instances, expected] : cases) {
        CAPTURE(instances);
        CHECK(complaint(instances) == "test.stp:" + std::string(expected));
    }
}

TEST_CASE("errors in arguments: place, #id, keyword, number of the argument [1]") {
    const std::pair<const char*, const char*> cases[] = {
        {"#1=A(1,,2);", "8:8: error: #1: A argument 2: expected a value, found ','"},
        {"#1=A(,1);", "8:6: error: #1: A argument 1: expected a value, found ','"},
        {"#1=A(1,);", "8:8: error: #1: A argument 2: expected a value, found ')'"},
        {"#1=A(1 2);", "8:8: error: #1: A argument 1: expected ',' or ')', found '2'"},
        {"#1=A(1,(2,(3,x)));",
         "8:15: error: #1: A argument 2: expected '(' after a keyword, found ')'"},
        {"#1=A(1.5.2);", "8:9: error: #1: A argument 1: expected ',' or ')', found '.'"},
        {"#1=A(.T);", "8:6: error: #1: A argument 1: expected a value, found '.'"},
        {"#1=A(..);", "8:6: error: #1: A argument 1: expected a value, found '.'"},
        {"#1=A(\"\");", "8:6: error: #1: A argument 1: expected a value, found '\"'"},
        {"#1=A(\"4F\");", "8:6: error: #1: A argument 1: expected a value, found '\"'"},
        {"#1=A(\"0G\");", "8:6: error: #1: A argument 1: expected a value, found '\"'"},
        {"#1=A(#);", "8:6: error: #1: A argument 1: expected a value, found '#'"},
        {"#1=A(#1a);", "8:6: error: #1: A argument 1: expected a value, found '#1a'"},
        {"#1=A(T());", "8:8: error: #1: A argument 1: expected a value, found ')'"},
        {"#1=A(T(1,2));",
         "8:9: error: #1: A argument 1: expected ')' after the one value of a type, found ','"},
        {"#1=A(<b.stp>);", "8:6: error: #1: A argument 1: expected a value, found '<'"},
        {"#1=A(1.#IND);", "8:8: error: #1: A argument 1: expected ',' or ')', found '#IND'"},
    };
    for (const auto& [instances, expected] : cases) {
        CAPTURE(instances);
        CHECK(complaint(instances) == "test.stp:" + std::string(expected));
    }
}

TEST_CASE("a string that is not closed is an error at its opening quote and swallows nothing [2]") {
    const std::string not_closed = "error: #1: the string that starts here is not closed";
    CHECK(complaint("#1=A('abc);\n#2=B('x');") == "test.stp:8:6: " + not_closed);
    CHECK(complaint("#1=A('abc);\n  #2 = B(1);\n#3=C('');") == "test.stp:8:6: " + not_closed);
    CHECK(complaint("#1=A('abc);") == "test.stp:8:6: " + not_closed);
    CHECK(complaint("#1=A(1,\n 'abc,'x');") ==
          "test.stp:9:2: error: #1: after the string that starts here expected ',' or ')', found "
          "'x'; is a quote "
          "missing?");
    CHECK(complaint("#1=A('abc);#2=B('x');") ==
          "test.stp:8:6: error: #1: after the string that starts here expected ',' or ')', found "
          "'x'; is a quote "
          "missing?");
    CHECK(error_of(good_header + "DATA;\n#1=A('abc") == "test.stp:8:6: " + not_closed);
    CHECK(error_of(
              "ISO-10303-21;\nHEADER;\nFILE_NAME('abc);\nENDSEC;\nDATA;\n#1=A('');\nENDSEC;\n") ==
          "test.stp:3:11: error: the string that starts here is not closed");
}

TEST_CASE("a comment that is not closed is an error [2]") {
    CHECK(complaint("#1=A(1);/* x\n#2=B();") ==
          "test.stp:8:9: error: expected an instance (#1=...) or ENDSEC;, found a comment that is "
          "never closed");
    CHECK(complaint("#1=A(1,/* x\n#2=B();") ==
          "test.stp:8:8: error: #1: expected ',' or ')', found a comment that is never closed");
    CHECK(complaint("#1=A('x'/* x\n#2=B();") ==
          "test.stp:8:9: error: #1: expected ',' or ')', found a comment that is never closed");
    CHECK(error_of("/* x\n" + step("")) ==
          "test.stp:1:1: error: the comment that starts here is never closed");
}

TEST_CASE("a file that is cut off says so [2]") {
    CHECK(error_of("ISO-10303") ==
          "test.stp:1:10: error: the file ends inside ISO-10303-21; is it cut off?");
    CHECK(error_of("ISO-10303-21;") ==
          "test.stp:1:14: error: the file ends before its DATA section; is it cut off?");
    CHECK(error_of("ISO-10303-21;\nHEADER;\n") ==
          "test.stp:3:1: error: the file ends inside its header; is it cut off?");
    CHECK(error_of(good_header) ==
          "test.stp:7:1: error: the file ends before its DATA section; is it cut off?");
    CHECK(error_of(good_header + "DATA;\n#1=A();\n") ==
          "test.stp:9:1: error: the file ends inside its DATA section, before ENDSEC; is it cut "
          "off?");
    CHECK(error_of(good_header + "DATA;\n#1=A();\n#7=B((1,2),3") ==
          "test.stp:9:5: error: #7: the file ends before the bracket that opens here is closed; is "
          "it cut off?");
    CHECK(error_of(good_header + "DATA;\n#7=") ==
          "test.stp:8:4: error: #7: expected a keyword, found the end of the file; is the file cut "
          "off?");
    CHECK(error_of(good_header + "ANCHOR;\n<a>=") ==
          "test.stp:8:5: error: the file ends inside a section; is it cut off?");
    CHECK(error_of(good_header + "SIGNATURE;\nabc") ==
          "test.stp:8:4: error: the file ends inside a SIGNATURE section; is it cut off?");
}

TEST_CASE("a section that is unknown is an error [2]") {
    CHECK(error_of(good_header + "DATA;\nENDSEC;\nMORE;\n") ==
          "test.stp:9:1: error: expected a section (DATA;) or END-ISO-10303-21;, found 'MORE'");
}

TEST_CASE("nesting: as deep as max_depth, not deeper [2]") {
    const auto nested = [](int depth) {
        return "#1=A" + std::string(static_cast<std::size_t>(depth), '(') + "1" +
               std::string(static_cast<std::size_t>(depth), ')') + ";";
    };
    CHECK(complaint(nested(max_depth)) == "");
    CHECK(complaint(nested(max_depth + 1)) ==
          "test.stp:8:69: error: #1: lists are nested deeper than 64");
    CHECK(complaint(nested(1000000)) ==
          "test.stp:8:69: error: #1: lists are nested deeper than 64");
    std::string typed = "#1=A(", scopes;
    for (int i = 0; i < 100000; ++i) typed += "T(";
    CHECK(complaint(typed).ends_with("lists are nested deeper than 64"));
    for (int i = 1; i < 100000; ++i) scopes += '#' + std::to_string(i) + "=&SCOPE\n";
    CHECK(complaint(scopes) == "test.stp:72:1: error: #65: scopes are nested deeper than 64");
}

TEST_CASE("an IFC building model is named as such [3]") {
    const std::string text =
        "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('ViewDefinition'),'2;1');\n"
        "FILE_NAME('','',(''),(''),'','','');\nFILE_SCHEMA (('IFC2X3'));\nENDSEC;\nDATA;\n"
        "#1=IFCPROJECT('x);\n";
    const auto file = File::parse("house.ifc", text);
    REQUIRE_FALSE(file.ok());
    CHECK(file.error().status == ExitStatus::unsupported);
    CHECK(to_string(file.error()) ==
          "house.ifc: error: this is an IFC building model (IFC2X3), which is not supported; "
          "expected a mechanical "
          "STEP file (AP203, AP214, AP242)");
}

TEST_CASE("files that cannot be read") {
    const auto missing = File::open("/no/such/file.stp");
    REQUIRE_FALSE(missing.ok());
    CHECK(missing.error().status == ExitStatus::input);
    CHECK(to_string(missing.error()) ==
          "/no/such/file.stp: error: cannot read: No such file or directory");
    const auto folder = File::open("/tmp");
    REQUIRE_FALSE(folder.ok());
    CHECK(to_string(folder.error()) == "/tmp: error: cannot read: Is a directory");
    const auto empty = File::open("/dev/null");
    REQUIRE_FALSE(empty.ok());
    CHECK(empty.error().message.starts_with("this is an empty file"));
}

TEST_CASE("files are mapped, whatever their size against the page") {
    const std::string path = tests::scratch("page.stp");
    for (const std::size_t size : {4095u, 4096u, 4097u, 8192u}) {
        std::string text = step("#1=A('');");
        text.insert(text.find("''") + 1, std::string(size - text.size(), 'x'));
        REQUIRE(text.size() == size);
        std::ofstream(path, std::ios::binary) << text;
        const auto file = File::open(path);
        REQUIRE(file.ok());
        CHECK((*file->arguments(InstanceIndex(0)))[0].as_string()->size() > 3000);
        // Cut so that the text ends with the page, inside a string.
        std::ofstream(path, std::ios::binary) << text.substr(0, 4096 - 100) + std::string(100, 'y');
        if (size > 4097) CHECK_FALSE(File::open(path).ok());
    }
    std::remove(path.c_str());
}

}  // namespace
}  // namespace lyr::part21
