// Values and arguments; numbers in brackets are those of the contract in value.h.

#include <vector>

#include "parser/part21/fields.h"
#include "parser/part21/step_text.h"

namespace lyr::part21 {
namespace {

Arguments arguments_of(const File& file, std::uint64_t id) {
    const InstanceIndex instance = file.find(id);
    REQUIRE(instance.valid());
    const auto arguments = file.arguments(instance);
    REQUIRE_MESSAGE(arguments.ok(), (arguments.ok() ? "" : to_string(arguments.error())));
    return *arguments;
}

TEST_CASE("every kind of value is told from the others") {
    const File file = with_instances(
        "#1=A($,*,12,-1.5,'s',\"0F\",.ITEM.,#1,@7,#PI,@E,(1),LABEL('x'),!OWN(1),.5,+3);");
    const Arguments arguments = arguments_of(file, 1);
    const Kind expected[] = {
        Kind::unset,           Kind::derived,  Kind::integer,     Kind::real,
        Kind::string,          Kind::binary,   Kind::enumeration, Kind::reference,
        Kind::value_reference, Kind::constant, Kind::constant,    Kind::list,
        Kind::typed,           Kind::typed,    Kind::real,        Kind::integer};
    REQUIRE(arguments.count() == std::size(expected));
    for (std::size_t i = 0; i < std::size(expected); ++i) {
        CAPTURE(i);
        CHECK(arguments[i].kind() == expected[i]);
    }
    CHECK(arguments[0].is_unset());
    CHECK(arguments[1].is_derived());
}

TEST_CASE("conversions give what is written") {
    const File file = with_instances("#1=A(12,-1.5,.T.,.F.,.U.,.milli.,#1,\"23A\",'s');");
    const Arguments arguments = arguments_of(file, 1);
    CHECK(*arguments[0].as_integer() == 12);
    CHECK(*arguments[0].as_real() == 12.0);  // [3]
    CHECK(*arguments[1].as_real() == -1.5);
    CHECK(*arguments[2].as_boolean());
    CHECK_FALSE(*arguments[3].as_boolean());
    CHECK(*arguments[4].as_logical() == Logical::unknown);
    CHECK(*arguments[5].as_enumeration() == "MILLI");  // [6]
    CHECK(*arguments[6].as_reference() == file.find(1));
    CHECK(*arguments[6].as_id() == 1);
    CHECK(arguments[7].as_binary()->unused_bits == 2);
    CHECK(arguments[7].as_binary()->hex_digits == "3A");
    CHECK(*arguments[8].as_string() == "s");
}

TEST_CASE("typed values and lists are walked in place [1]") {
    const File file = with_instances(
        "#1=A(LENGTH_MEASURE(25.4),((1,2),(),(3)),/*c*/ Outer ( INNER ( (1,'),(') ) ) ,( /*e*/ "
        "));");
    const Arguments arguments = arguments_of(file, 1);
    REQUIRE(arguments.count() == 4);
    CHECK(arguments[0].as_typed()->keyword == "LENGTH_MEASURE");
    CHECK(*arguments[0].untyped().as_real() == 25.4);
    std::vector<std::size_t> counts;
    const auto rows = arguments[1].as_list();
    for (const Value& row : *rows) counts.push_back(row.as_list()->count());
    CHECK(counts == std::vector<std::size_t>{2, 0, 1});
    const auto outer = arguments[2].as_typed();
    CHECK(outer->keyword == "OUTER");
    CHECK(outer->keyword.as_written == "Outer");
    CHECK(outer->value.as_typed()->value.as_list()->count() == 2);
    CHECK(arguments[2].untyped().is_list());
    CHECK(arguments[3].as_list()->empty());
}

TEST_CASE("arguments beyond the directly indexed ones are found") {
    std::string text = "#1=A(";
    for (int i = 0; i < 50; ++i) {
        if (i > 0) text += ',';
        text += std::to_string(i) + " /*,*/ ";
    }
    const File file = with_instances(text + ");");
    const Arguments arguments = arguments_of(file, 1);
    REQUIRE(arguments.count() == 50);
    std::size_t next = 0;
    for (const Value& argument : arguments) {
        CHECK(*argument.as_integer() == static_cast<int>(next));
        CHECK(*arguments[next].as_integer() == static_cast<int>(next));
        const std::string named = "A argument " + std::to_string(++next) + ": ";
        CHECK(argument.expected("x").message.starts_with(named));
    }
    CHECK(next == 50);
}

TEST_CASE("members of nested lists carry the number of their argument [2]") {
    const File file = with_instances("#1=A(1,(2,(3,4)),5);");
    const Arguments arguments = arguments_of(file, 1);
    const auto outer = arguments[1].as_list();
    for (const Value& member : *outer) CHECK(member.error("x").message == "A argument 2: x");
}

TEST_CASE("whole lists at once") {
    const File file = with_instances("#1=A((1.,2,3.5),(#1,#2),(4,5));\n#2=B();");
    const Arguments arguments = arguments_of(file, 1);
    std::vector<double> reals;
    REQUIRE(arguments[0].append_reals(reals).ok());
    CHECK(reals == std::vector<double>{1, 2, 3.5});
    std::vector<InstanceIndex> references;
    REQUIRE(arguments[1].append_references(references).ok());
    CHECK(references == std::vector{file.find(1), file.find(2)});
    std::vector<std::int64_t> integers;
    REQUIRE(arguments[2].append_integers(integers).ok());
    CHECK(integers == std::vector<std::int64_t>{4, 5});
    double few[2];
    CHECK_FALSE(arguments[0].read_reals(few).ok());
    double enough[3];
    CHECK(*arguments[0].read_reals(enough) == 3);
    CHECK(enough[2] == 3.5);
}

TEST_CASE(
    "a wrong type is an error that says where, which argument, what was expected and found [2]") {
    const File file =
        with_instances("#1=B();\n  #57 = CIRCLE('c',12.5,\n  #1,.T.,(1,'x'),NUMBER(3));");
    const Arguments arguments = arguments_of(file, 57);
    const auto line = [](const auto& result) { return to_string(result.error()); };
    CHECK(line(arguments[0].as_reference()) ==
          "test.stp:9:16: error: #57: CIRCLE argument 1: expected a reference #id, found 'c'");
    CHECK(line(arguments[1].as_integer()) ==
          "test.stp:9:20: error: #57: CIRCLE argument 2: expected an integer, found 12.5");
    CHECK(line(arguments[2].as_real()) ==
          "test.stp:10:3: error: #57: CIRCLE argument 3: expected a real number, found #1");
    CHECK(line(arguments[3].as_list()) ==
          "test.stp:10:6: error: #57: CIRCLE argument 4: expected a list, found .T.");
    std::vector<double> reals;
    CHECK(line(arguments[4].append_reals(reals)) ==
          "test.stp:10:13: error: #57: CIRCLE argument 5: expected a real number, found 'x'");
    CHECK(line(arguments[5].as_real()) ==
          "test.stp:10:18: error: #57: CIRCLE argument 6: expected a real number, found NUMBER(3)");
    CHECK(line(arguments[3].as_string()) ==
          "test.stp:10:6: error: #57: CIRCLE argument 4: expected a string, found .T.");
    CHECK(line(arguments[0].as_boolean()) ==
          "test.stp:9:16: error: #57: CIRCLE argument 1: expected .T. or .F., found 'c'");
    CHECK_FALSE(arguments[0].as_binary().ok());
    CHECK_FALSE(arguments[0].as_typed().ok());
    CHECK_FALSE(arguments[0].as_enumeration().ok());
    CHECK_FALSE(arguments[0].as_logical().ok());
    CHECK_FALSE(arguments[0].as_integer().ok());
}

TEST_CASE("an argument that is missing is named as such [2]") {
    const File file = with_instances("#5=CIRCLE('',#5);");
    const Arguments arguments = arguments_of(file, 5);
    CHECK(to_string(arguments[2].as_real().error()) ==
          "test.stp:8:16: error: #5: CIRCLE argument 3: expected a real number, found nothing");
    CHECK(to_string(arguments.expect_count(3).error()) ==
          "test.stp:8:10: error: #5: CIRCLE: expected 3 arguments, found 2");
    CHECK(arguments.expect_count(2).ok());
}

TEST_CASE("dangling references and those into other files are explained [4]") {
    const std::string text = good_header +
                             "REFERENCE;\n#9=<bolt.stp#head>;\nENDSEC;\nDATA;\n"
                             "#1=A(#8,#9,@3,#99999999999999999999);\nENDSEC;\nEND-ISO-10303-21;\n";
    const File file = parsed(text);
    const Arguments arguments = arguments_of(file, 1);
    CHECK(to_string(arguments[0].as_reference().error()) ==
          "test.stp:11:6: error: #1: A argument 1: #8 is not defined in the file");
    CHECK(*arguments[0].as_id() == 8);
    CHECK(to_string(arguments[1].as_reference().error()) ==
          "test.stp:11:9: error: #1: A argument 2: #9 is in another file, <bolt.stp#head>, and "
          "references "
          "to other files are not supported");
    CHECK(arguments[1].as_reference().error().status == ExitStatus::unsupported);
    CHECK(arguments[2].as_reference().error().status == ExitStatus::unsupported);
    CHECK(to_string(arguments[3].as_reference().error()) ==
          "test.stp:11:15: error: #1: A argument 4: expected an #id of at most 64 bits, found "
          "#99999999999999999999");
    CHECK(*file.external_reference(9) == "<bolt.stp#head>");
    CHECK_FALSE(file.external_reference(1));
}

TEST_CASE("values outlive a move of their file") {
    auto file = std::make_unique<File>(with_instances("#1=A(2.5);"));
    const Value value = arguments_of(*file, 1)[0];
    const File moved = std::move(*file);
    file.reset();
    CHECK(*value.as_real() == 2.5);
}

TEST_CASE("fields: the first error stays and everything after it is empty") {
    const File file = with_instances("#1=B();\n#2=A('n',#1,2.,(1.,2.),(#1),$,.T.,3,.X.);");
    Fields good(file, file.find(2), 9);
    CHECK(good.string(0) == "n");
    CHECK(good.reference(1) == file.find(1));
    CHECK(good.real(2) == 2.0);
    CHECK(good.reals(3).size() == 2);
    CHECK(good.references(4).size() == 1);
    CHECK_FALSE(good.optional_reference(5).valid());
    CHECK(good.optional_reference(1).valid());
    CHECK(good.boolean(6));
    CHECK(good.logical(6) == Logical::yes);
    CHECK(good.integer(7) == 3);
    CHECK(good.enumeration(8) == "X");
    CHECK(good.list(3).count() == 2);
    CHECK(good.ok());
    CHECK(good.real(0) == 0.0);
    CHECK(good.reference(2) == InstanceIndex());
    CHECK(good.reals(3).empty());
    CHECK(to_string(good.error()) ==
          "test.stp:9:6: error: #2: A argument 1: expected a real number, found 'n'");

    Fields wrong_count(file, file.find(2), 3);
    CHECK(to_string(wrong_count.error()) ==
          "test.stp:9:5: error: #2: A: expected 3 arguments, found 9");
    CHECK(wrong_count.list(3).empty());

    Fields missing(file, file.find(1), 0);
    CHECK_FALSE(missing.optional_reference(4).valid());
    CHECK_FALSE(missing.ok());
}

}  // namespace
}  // namespace lyr::part21
