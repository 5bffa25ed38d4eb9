#include "target/control/session.h"

#include <doctest/doctest.h>

#include <random>
#include <vector>

using namespace lyr::control;

namespace {

// All that waits.
std::vector<std::string> lines_of(Session& session) {
    std::vector<std::string> lines;
    while (const auto line = session.take())
        lines.push_back(line->too_long ? "(long)" : line->text);
    return lines;
}

using Lines = std::vector<std::string>;

}  // namespace

TEST_CASE("session 1: lines come out whole and in order, however the bytes are split") {
    const std::string text = "one\ntwo\r\n\n" + std::string(most_line_bytes, 'x') + "\nlast\nrest";
    const Lines expected{"one", "two", "", std::string(most_line_bytes, 'x'), "last"};
    std::mt19937 random(1);
    for (int round = 0; round < 200; ++round) {
        Session session;
        Lines lines;
        const std::size_t most = 1 + random() % (round % 2 ? 8 : most_line_bytes);
        for (std::size_t at = 0; at < text.size();) {
            const std::size_t count = 1 + random() % most;
            REQUIRE(session.wants_more());
            session.receive(text.substr(at, count));
            at += count;
            for (std::string& line : lines_of(session)) lines.push_back(std::move(line));
        }
        REQUIRE(lines == expected);
    }
}

TEST_CASE("session 2: a line that is too long is told once and skipped") {
    for (const std::size_t length :
         {most_line_bytes + 1, 3 * most_line_bytes, std::size_t{100'000}}) {
        Session session;
        Lines lines;
        const std::string text = "a\n" + std::string(length, '{') + "\nb\n";
        for (std::size_t at = 0; at < text.size(); at += most_line_bytes) {
            REQUIRE(session.wants_more());
            session.receive(text.substr(at, most_line_bytes));
            for (std::string& line : lines_of(session)) lines.push_back(std::move(line));
        }
        CHECK(lines == Lines{"a", "(long)", "b"});
    }
}

TEST_CASE("session 3: who does not take answers gets no more, and gets all of them later") {
    Session session;
    const std::string answer(100, 'y');
    std::size_t asked = 0, answered = 0;
    std::string held;
    while (session.wants_more()) {
        session.receive(std::string(64, '\n'));
        asked += 64;
        while (session.take()) {
            session.answer(answer);
            ++answered;
        }
    }
    CHECK(answered < asked);
    CHECK(session.unsent().size() >= Session::full_bytes);
    CHECK(session.unsent().size() < Session::full_bytes + 2 * answer.size());
    while (!session.unsent().empty()) {
        session.sent(std::min<std::size_t>(1000, session.unsent().size()));
        while (session.take()) {
            session.answer(answer);
            ++answered;
        }
    }
    CHECK(answered == asked);
    CHECK(session.wants_more());
}

TEST_CASE("session 3: answers that were sent were kept as long as one more was waiting") {
    Session session;
    std::string expected, got;
    for (int i = 0; i < 3'000; ++i) {
        const std::string answer = std::to_string(i) + std::string(60, 'y');
        session.answer(answer);
        expected += answer + '\n';
        const std::size_t bytes = session.unsent().size() - 1;
        got += session.unsent().substr(0, bytes);
        session.sent(bytes);
        CHECK(session.held_bytes() <= Session::full_bytes + 2 * answer.size());
    }
    CHECK(got + std::string(session.unsent()) == expected);
}
