// lyrrun's options that look at the board in place of a print: whether it has what the printer's file names, and how
// well it keeps time.

#pragma once

#include "apps/command_line.h"
#include "target/config/printer.h"

namespace lyr::command_line {

struct BoardArguments {
    bool check = false, measure = false, lines = false, off = false;
    double seconds = 10;
    bool has_seconds = false;  // they were given

    bool given() const { return check || measure || lines || off; }
};

void add_board_options(Options& app, BoardArguments& arguments);

// What the options ask for; the report on standard output.
Status work_board(const Program& program, const BoardArguments& arguments,
                  const config::Printer& printer, bool json);

}  // namespace lyr::command_line
