// Exchange structures for tests.

#pragma once

#include <doctest/doctest.h>

#include <string>

#include "parser/part21/part21.h"

namespace lyr::part21 {

inline const std::string good_header =
    "ISO-10303-21;\n"
    "HEADER;\n"
    "FILE_DESCRIPTION(('part'),'2;1');\n"
    "FILE_NAME('part.stp','2024-01-01T00:00:00',('A','B'),('C'),'writer 1','cad 2','nobody');\n"
    "FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));\n"
    "ENDSEC;\n";

// The first byte of `instances` stands in line 8, column 1.
inline std::string step(const std::string& instances) {
    return good_header + "DATA;\n" + instances + "\nENDSEC;\nEND-ISO-10303-21;\n";
}

inline File parsed(const std::string& text) {
    auto file = File::parse("test.stp", text);
    REQUIRE_MESSAGE(file.ok(), (file.ok() ? "" : to_string(file.error())));
    return std::move(*file);
}

inline File with_instances(const std::string& instances) {
    return parsed(step(instances));
}

// "" when the text is read.
inline std::string error_of(const std::string& text) {
    const auto file = File::parse("test.stp", text);
    return file ? "" : to_string(file.error());
}

// The line that indexing, or else the arguments of the first instance, complain with.
inline std::string complaint(const std::string& instances) {
    const auto file = File::parse("test.stp", step(instances));
    if (!file) return to_string(file.error());
    const auto arguments = file->arguments(file->record(InstanceIndex(0), std::size_t{0}));
    return arguments ? "" : to_string(arguments.error());
}

// A small file with one of everything, in which every instance reads without error.
inline const std::string good_instances =
    "#1=CARTESIAN_POINT('origin',(0.,-1.5E-3,25.4));\n"
    "#2=DIRECTION('it''s; /* no comment */ #9=X(',(0.,0.,1.));\n"
    "/* a comment; with 'quotes' and #7=A(); */\n"
    "#3 = AXIS2_PLACEMENT_3D ( '' , #1 , /* here too */ #2 , $ ) ;\n"
    "#10=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));\n"
    "#20=TRIMMED_CURVE('\\X2\\03C0\\X0\\',#3,(#1,PARAMETER_VALUE(0.)),(#1,PARAMETER_VALUE(1)),.T.,"
    "\n"
    "  .CARTESIAN.);\n"
    "#30=GRID((((1,2),(3,4)),((5,6),())),\"23A\",.U.,!OWN(LABEL('x')));\n"
    "#40=NOTHING();";

}  // namespace lyr::part21
