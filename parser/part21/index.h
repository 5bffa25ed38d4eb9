// The one pass over the text: sections, instances, records. Arguments are only skipped, but with
// strings, comments and brackets taken for what they are, so that an instance ends where it ends.
//
// Scopes of edition 1 (#1=&SCOPE #2=..; ENDSCOPE /#2/ A(..);) are opened: the instances inside are
// instances of the file like all others, in front of the one that they belong to.

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "parser/part21/table.h"

namespace lyr::part21 {

// Functions that can fail return false and leave the reason in error().
class Indexer {
public:
    explicit Indexer(Table& table);

    bool run();
    const Diagnostic& error() const { return *error_; }

private:
    struct Scope {
        std::uint64_t id;
        const char* place;
    };

    // index.cpp: sections
    bool start();
    bool sections();
    bool section(std::string_view word);
    bool header_section();
    bool header_entry();
    bool recover_in_header();
    bool check_schema();
    bool skipped_section(bool is_reference);
    bool reference_entry();
    bool skip_statement();
    bool signature_section();
    bool finish(bool ended);
    void check_rest();

    // index_data.cpp: the DATA section
    bool data_section();
    bool instance();
    bool body(std::uint64_t id, const char* place);
    bool complex_body();
    bool close_scope();
    bool record();
    bool skip_list(int depth);
    bool string_in_list();
    bool build_lookup();

    void blank();
    bool at(char c) const { return p_ < end_ && *p_ == c; }
    bool at_comment() const;        // behind blank(): one that is never closed
    std::string_view word() const;  // the word at p_, with "-", not yet taken
    bool take(char c, std::string_view where);
    bool expected(std::string_view what);
    bool fail(const char* place, std::string message, ExitStatus status = ExitStatus::input);
    void warn(const char* place, std::string message);

    Table& table_;
    const char* p_;
    const char* const end_;
    std::optional<std::uint64_t> id_;  // of the instance that is being read
    std::vector<Scope> scopes_;
    bool has_header_ = false;
    bool has_data_ = false;
    int passed_over_ = 0;  // entries of the header
    std::optional<Diagnostic> error_;
};

}  // namespace lyr::part21
