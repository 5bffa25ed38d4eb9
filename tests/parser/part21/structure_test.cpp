// Sections, instances and records; numbers in brackets are those of the contract in part21.h.

#include <thread>

#include "parser/part21/decode_all.h"
#include "parser/part21/step_text.h"

namespace lyr::part21 {
namespace {

TEST_CASE("header, instances, keywords and records of a small file") {
    const File file = with_instances(good_instances);
    CHECK(file.diagnostics().empty());
    CHECK(file.name() == "test.stp");
    const Header& header = file.header();
    CHECK(header.description == std::vector<std::string>{"part"});
    CHECK(header.implementation_level == "2;1");
    CHECK(header.name == "part.stp");
    CHECK(header.time_stamp == "2024-01-01T00:00:00");
    CHECK(header.authors == std::vector<std::string>{"A", "B"});
    CHECK(header.organizations == std::vector<std::string>{"C"});
    CHECK(header.preprocessor_version == "writer 1");
    CHECK(header.originating_system == "cad 2");
    CHECK(header.authorization == "nobody");
    CHECK(header.schemas ==
          std::vector<std::string>{"AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }"});

    REQUIRE(file.instance_count() == 7);
    const std::uint64_t ids[] = {1, 2, 3, 10, 20, 30, 40};
    for (std::size_t i = 0; i < 7; ++i) {
        CHECK(file.id(InstanceIndex(i)) == ids[i]);
        CHECK(file.find(ids[i]) == InstanceIndex(i));
    }
    for (const std::uint64_t id : {0ul, 4ul, 9ul, 41ul, 1ul << 40})
        CHECK_FALSE(file.find(id).valid());
    CHECK(file.type_name(file.find(3)) == "AXIS2_PLACEMENT_3D");
    CHECK(file.keyword(file.keyword_of(file.find(40))) == "NOTHING");
    CHECK(file.arguments(file.find(40))->count() == 0);

    const InstanceIndex unit = file.find(10);
    CHECK(file.is_complex(unit));
    CHECK_FALSE(file.keyword_of(unit).valid());
    CHECK(file.type_name(unit) == "(LENGTH_UNIT NAMED_UNIT SI_UNIT)");
    REQUIRE(file.record_count(unit) == 3);
    CHECK(file.record(unit, "SI_UNIT") == file.record(unit, 2));
    CHECK_FALSE(file.record(unit, "PLANE_ANGLE_UNIT").valid());
    CHECK(file.instance_of(file.record(unit, "NAMED_UNIT")) == unit);
    CHECK(*(*file.arguments(file.record(unit, "SI_UNIT")))[0].as_enumeration() == "MILLI");
    CHECK(to_string(file.arguments(unit).error()) ==
          "test.stp:12:1: error: #10: expected a simple instance, found the complex "
          "(LENGTH_UNIT NAMED_UNIT SI_UNIT)");
    CHECK(file.is(unit, "LENGTH_UNIT"));
    CHECK_FALSE(file.is(unit, "CARTESIAN_POINT"));
    CHECK_FALSE(file.is(unit, "NO_SUCH_KEYWORD"));
    CHECK(decode_all(file).errors == 0);
}

TEST_CASE("instances of a keyword, simple or complex, in the order of the file") {
    const File file =
        with_instances("#9=B();\n#5=A();\n#7=(A()C());\n#6=a();\n#8=(A()A());\n#1=AB();");
    const auto ids = [&](std::string_view keyword) {
        std::vector<std::uint64_t> found;
        for (const InstanceIndex i : file.instances_of(keyword)) found.push_back(file.id(i));
        return found;
    };
    CHECK(ids("A") == std::vector<std::uint64_t>{5, 7, 6, 8});
    CHECK(ids("C") == std::vector<std::uint64_t>{7});
    CHECK(ids("X").empty());
    CHECK(ids("").empty());
    CHECK(ids("FILE_NAME").empty());  // of the header
    const auto matching = file.instances_where(
        [](std::string_view keyword) { return keyword == "C" || keyword == "A"; });
    CHECK(matching == file.instances_of("A"));
    CHECK(file.instances_where([](std::string_view) { return true; }).size() == 6);
    CHECK(file.instances_where([](std::string_view keyword) { return keyword == "FILE_NAME"; })
              .empty());
}

TEST_CASE("keywords are met without regard to case") {
    const File file = parsed(
        "Iso-10303-21;\nHeader;\nfile_description((''),'');file_name('','',(''),(''),'','','');\n"
        "File_Schema(('config_control_design'));EndSec;\nData;\n#1=Cartesian_Point('',(1.,2.,3.));"
        "\n"
        "#2=CARTESIAN_POINT('',(1.,2.,3.));EndSec;\nEnd-ISO-10303-21;\n");
    CHECK(file.diagnostics().empty());
    CHECK(file.instances_of("CARTESIAN_POINT").size() == 2);
    CHECK(file.header().schemas.size() == 1);
}

TEST_CASE("many keywords and many ids, close or far apart [6]") {
    for (const std::uint64_t stride : {1ull, 10ull, 1000003ull, 1ull << 43}) {
        CAPTURE(stride);
        std::string text;
        for (std::uint64_t i = 5000; i > 0; --i) {
            const std::string number = std::to_string(i);
            text += '#' + std::to_string(i * stride) + "=KEYWORD_NUMBER_" + number + "(" + number +
                    ");\n";
        }
        const File file = with_instances(text);
        REQUIRE(file.instance_count() == 5000);
        for (std::uint64_t i = 1; i <= 5000; i += 31) {
            const InstanceIndex found = file.find(i * stride);
            REQUIRE(found.valid());
            CHECK(*(*file.arguments(found))[0].as_integer() == static_cast<std::int64_t>(i));
            CHECK(file.instances_of("KEYWORD_NUMBER_" + std::to_string(i)) == std::vector{found});
        }
        CHECK_FALSE(file.find(0).valid());
        CHECK_FALSE(file.find(5001 * stride).valid());
        if (stride > 1) CHECK_FALSE(file.find(stride + 1).valid());
    }
}

TEST_CASE("the largest #id is found") {
    const File file =
        with_instances("#18446744073709551615=A(#1);\n#1=A(#18446744073709551615);\n#0=B();");
    CHECK(file.find(18446744073709551615ull) == InstanceIndex(0));
    CHECK(decode_all(file).errors == 0);
    CHECK(file.find(0) == InstanceIndex(2));
    CHECK(with_instances("#00012=A();").find(12).valid());
}

TEST_CASE("comments, blanks and print directives may stand between any two tokens") {
    const std::vector<std::string> tokens = {"ISO-10303-21",
                                             ";",
                                             "HEADER",
                                             ";",
                                             "FILE_DESCRIPTION",
                                             "(",
                                             "(",
                                             "''",
                                             ")",
                                             ",",
                                             "'2;1'",
                                             ")",
                                             ";",
                                             "FILE_NAME",
                                             "(",
                                             "'n'",
                                             ",",
                                             "''",
                                             ",",
                                             "(",
                                             "''",
                                             ")",
                                             ",",
                                             "(",
                                             "''",
                                             ")",
                                             ",",
                                             "''",
                                             ",",
                                             "''",
                                             ",",
                                             "''",
                                             ")",
                                             ";",
                                             "FILE_SCHEMA",
                                             "(",
                                             "(",
                                             "'S'",
                                             ")",
                                             ")",
                                             ";",
                                             "ENDSEC",
                                             ";",
                                             "DATA",
                                             ";",
                                             "#1",
                                             "=",
                                             "A",
                                             "(",
                                             "1.5",
                                             ",",
                                             "#2",
                                             ",",
                                             "(",
                                             "$",
                                             ",",
                                             "*",
                                             ")",
                                             ",",
                                             "T",
                                             "(",
                                             "\"0A\"",
                                             ")",
                                             ",",
                                             ".X.",
                                             ")",
                                             ";",
                                             "#2",
                                             "=",
                                             "(",
                                             "B",
                                             "(",
                                             "'x'",
                                             ")",
                                             "C",
                                             "(",
                                             ")",
                                             ")",
                                             ";",
                                             "ENDSEC",
                                             ";",
                                             "END-ISO-10303-21",
                                             ";"};
    const auto joined = [&](const std::string& between) {
        std::string text;
        for (const std::string& token : tokens) text += between + token;
        return text + between;
    };
    const Decoded plain = decode_all(parsed(joined("\n")));
    CHECK(plain.errors == 0);
    CHECK(plain.values == 9);
    CHECK(plain == decode_all(parsed(joined(""))));
    for (const char* between :
         {" ", "\t\r\n", "\r", "\f\v", "/**/", "/* ; ' ) #1=A( */", "/***/", "/* /* */",
          " /* a */ /* b */\n", "\\N\\", " \\F\\ ", "/*'*/", "/*\xE9*/"}) {
        CAPTURE(between);
        const File file = parsed(joined(between));
        CHECK(file.diagnostics().empty());
        CHECK(decode_all(file) == plain);
    }
}

TEST_CASE("a byte order mark, blanks and comments may stand before the start [4]") {
    for (const char* before :
         {"\xEF\xBB\xBF", " \n\n", "/* made by hand */\n", "\xEF\xBB\xBF /* c */ "}) {
        const File file = parsed(before + step("#1=A();"));
        CHECK(file.diagnostics().empty());
        CHECK(file.instance_count() == 1);
    }
}

TEST_CASE("odd headers are read with warnings [4]") {
    const std::string data = "DATA;\n#1=A();\nENDSEC;\nEND-ISO-10303-21;\n";
    const std::string rest = "FILE_NAME('','',(''),(''),'','','');FILE_SCHEMA(('S'));ENDSEC;\n";
    const std::vector<std::pair<std::string, std::vector<std::string>>> cases = {
        {"HEADER;ENDSEC;\n",
         {"test.stp: warning: the header has no readable FILE_DESCRIPTION",
          "test.stp: warning: the header has no readable FILE_NAME",
          "test.stp: warning: the header has no readable FILE_SCHEMA"}},
        {"HEADER;FILE_DESCRIPTION('','2;1','more');" + rest,
         {"test.stp:1:37: warning: FILE_DESCRIPTION: expected 2 arguments, found 3"}},
        {"HEADER;FILE_DESCRIPTION('its'name',$);" + rest,
         {"test.stp:1:38: warning: header entry passed over: after the string that starts here "
          "expected ',' or "
          "')', found 'name'; is a quote missing?",
          "test.stp: warning: the header has no readable FILE_DESCRIPTION"}},
        {"HEADER;FILE_DESCRIPTION;" + rest,
         {"test.stp:1:37: warning: header entry passed over: expected '(' after FILE_DESCRIPTION, "
          "found ';'",
          "test.stp: warning: the header has no readable FILE_DESCRIPTION"}},
        {"HEADER;FILE_DESCRIPTION((''),abc);" + rest,
         {"test.stp:1:46: warning: FILE_DESCRIPTION argument 2: expected '(' after a keyword, "
          "found ')'",
          "test.stp: warning: the header has no readable FILE_DESCRIPTION"}},
        {"HEADER;FILE_DESCRIPTION($,12);" + rest,
         {"test.stp:1:40: warning: FILE_DESCRIPTION argument 2: expected a string, found 12"}},
        {"HEADER;FILE_DESCRIPTION((''),'');OWN_ENTRY(1,(2));" + rest, {}},
    };
    for (const auto& [header, warnings] : cases) {
        CAPTURE(header);
        const File file = parsed("ISO-10303-21;" + header + data);
        std::vector<std::string> lines;
        for (const Diagnostic& diagnostic : file.diagnostics())
            lines.push_back(to_string(diagnostic));
        CHECK(lines == warnings);
        CHECK(file.instance_count() == 1);
    }
}

TEST_CASE("missing ends and starts of sections that lose nothing are warnings [4]") {
    const auto only_warning = [](const std::string& text) {
        const File file = parsed(text);
        CHECK(file.instance_count() == 1);
        REQUIRE(file.diagnostics().size() == 1);
        CHECK(file.diagnostics()[0].severity == Severity::warning);
        return to_string(file.diagnostics()[0]);
    };
    const std::string data = "DATA;\n#1=A();\nENDSEC;\n";
    CHECK(only_warning(good_header + data) ==
          "test.stp:10:1: warning: END-ISO-10303-21; is missing at the end of the file");
    CHECK(only_warning(good_header + data + "END-ISO-103") ==
          "test.stp:10:12: warning: END-ISO-10303-21; is missing at the end of the file");
    CHECK(only_warning(good_header + data + "END-ISO-10303-21") ==
          "test.stp:10:17: warning: END-ISO-10303-21; is missing at the end of the file");
    CHECK(only_warning(good_header.substr(14) + data + "END-ISO-10303-21;") ==
          "test.stp:1:1: warning: ISO-10303-21; is missing before HEADER;");
    CHECK(
        only_warning(good_header.substr(0, good_header.size() - 8) + data + "END-ISO-10303-21;") ==
        "test.stp:6:1: warning: ENDSEC; is missing before DATA;");
    CHECK(only_warning("ISO-10303-21;\n" + data + "END-ISO-10303-21;") ==
          "test.stp:1:1: warning: the file has no HEADER section");
    CHECK(only_warning(step("#1=A();") + "rubbish") ==
          "test.stp:11:1: warning: what follows END-ISO-10303-21; is not read");
    CHECK(only_warning(step("#1=A();") + step("#2=A();")) ==
          "test.stp:11:1: warning: a second exchange structure follows in the same file; it is not "
          "read");
}

TEST_CASE("NUL bytes and Ctrl-Z behind the end are no concern of anyone") {
    const File file =
        parsed(step("#1=A();") + std::string(3, '\0') + "\x1A\n" + std::string(2, '\0'));
    CHECK(file.diagnostics().empty());
}

TEST_CASE("several DATA sections, with parameters, share one table [2]") {
    const File file =
        parsed(good_header +
               "DATA('first; part',('S'));\n#1=A(#2);\nENDSEC;\n"
               "DATA ( 'second' , ('T') ) ;\n#2=A(#1);\nENDSEC;\nEND-ISO-10303-21;\n");
    CHECK(file.instance_count() == 2);
    CHECK(decode_all(file).errors == 0);
    CHECK(error_of(good_header +
                   "DATA;\n#1=A();\nENDSEC;\nDATA;\n#1=A();\nENDSEC;\nEND-ISO-10303-21;\n") ==
          "test.stp:11:1: error: #1: this instance name is defined twice, first in line 8; "
          "expected each #id once");
}

TEST_CASE("anchor, reference and signature sections are passed over [5]") {
    const std::string text =
        good_header +
        "ANCHOR;\n<part;'1>=#1;\n<a>=('x;',$,<http://x/y;z#w>){tag:'ENDSEC;'};\nENDSEC;\n"
        "REFERENCE;\n#8=<a.stp#1>;\n@9=<b.stp#2>; /* ; */ #7 = <c;d.stp#'>;\nENDSEC;\n"
        "DATA;\n#1=A(#PI,@E);\nENDSEC;\nEND-ISO-10303-21;\n"
        "SIGNATURE;\nMIIB/*xx'abc\n==\nENDSEC;\nSIGNATURE\nAAAA ENDSEC ;\n";
    const File file = parsed(text);
    CHECK(file.diagnostics().empty());
    CHECK(file.instance_count() == 1);
    CHECK(*file.external_reference(8) == "<a.stp#1>");
    CHECK(*file.external_reference(7) == "<c;d.stp#'>");
    CHECK_FALSE(file.external_reference(9));
    const Decoded decoded = decode_all(file);
    REQUIRE(decoded.errors == 2);
    CHECK(decoded.first_errors[0].status == ExitStatus::unsupported);
}

TEST_CASE("a file without DATA section is read with a warning") {
    const File file = parsed(good_header + "END-ISO-10303-21;\n");
    CHECK(file.instance_count() == 0);
    CHECK(file.diagnostics().size() == 1);
    CHECK(file.instances_of("A").empty());
    CHECK_FALSE(file.find(1).valid());
}

TEST_CASE("scopes of edition 1 are opened") {
    const File file = with_instances(
        "#1=&SCOPE\n#2=A(#3);\n#4= & SCOPE #3=B(1); ENDSCOPE C(#3);\nENDSCOPE /#2, #4/ "
        "D(#2,#4);\n#5=D(#1,#2);");
    REQUIRE(file.instance_count() == 5);
    CHECK(decode_all(file).errors == 0);
    CHECK(file.type_name(file.find(1)) == "D");
    CHECK(file.type_name(file.find(4)) == "C");
    CHECK(file.location(file.find(4)).line == 10);
}

TEST_CASE("lines end with LF, CR LF or CR [7]") {
    for (const std::string line_end : {"\n", "\r\n", "\r"}) {
        std::string text = step("#1=A();\n\n #2=A(@);");
        for (std::size_t i = 0; (i = text.find('\n', i)) != text.npos; i += line_end.size()) {
            text.replace(i, 1, line_end);
        }
        const File file = parsed(text);
        const Location where = file.location(file.find(2));
        CHECK(where.line == 10);
        CHECK(where.column == 2);
        CHECK(where.entity == 2);
    }
}

TEST_CASE("places are right far into a long file and a long line [7]") {
    // Some line end lies across every border of a block.
    for (const std::string line_end : {"\n", "\r\n", "\r"}) {
        std::string text;
        for (int i = 1; i <= 20000; ++i) text += '#' + std::to_string(i) + "=A();" + line_end;
        const File file = with_instances(text);
        for (std::uint64_t id = 1; id <= 20000; ++id) {
            const Location where = file.location(file.find(id));
            if (where.line == id + 7 && where.column == 1) continue;
            FAIL_CHECK("#" << id << " at " << where.line << ":" << where.column);
        }
    }
    const File one_line = with_instances("#1=A('" + std::string(200000, 'x') + "'); #2=A();");
    CHECK(one_line.location(one_line.find(2)).line == 8);
    CHECK(one_line.location(one_line.find(2)).column == 6 + 200000 + 5);
}

TEST_CASE("several threads read one file [6]") {
    const File file = with_instances(good_instances + "\n#50=A(#51);");
    const Decoded expected = decode_all(file);
    std::vector<Decoded> results(4);
    std::vector<std::thread> threads;
    for (Decoded& result : results) {
        threads.emplace_back([&] { result = decode_all(file); });
    }
    for (std::thread& thread : threads) thread.join();
    for (const Decoded& result : results) {
        CHECK(result == expected);
        REQUIRE(result.errors == 1);
        CHECK(to_string(result.first_errors[0]) == to_string(expected.first_errors[0]));
    }
}

}  // namespace
}  // namespace lyr::part21
