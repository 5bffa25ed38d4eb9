#include "target/gpio/fake_board.h"

#include <cerrno>
#include <mutex>

namespace lyr::tests {
namespace {

std::mutex wires;

}  // namespace

FakeBoard& board() {
    static FakeBoard one;
    return one;
}

bool FakeBoard::must_fail(Call call) {
    if (!fails || call != failing) return false;
    fails = false;
    errno = EIO;
    return true;
}

FakeChip* FakeBoard::chip_at(const std::string& path) {
    errno = ENOENT;
    if (must_fail(Call::open)) errno = EACCES;
    for (FakeChip& chip : chips)
        if (errno == ENOENT && path.ends_with('/' + chip.name)) {
            ++opened;
            return &chip;
        }
    return nullptr;
}

bool FakeBoard::take(FakeChip& chip, const std::vector<unsigned>& numbers, const char* user) {
    if (must_fail(Call::request)) return false;
    for (const unsigned number : numbers)
        if (!chip.lines.at(number).user.empty()) {
            errno = EBUSY;
            return false;
        }
    for (const unsigned number : numbers) chip.lines.at(number).user = user;
    ++requests;
    return true;
}

void FakeBoard::watch(FakeLine& line) {
    const std::lock_guard lock(wires);
    line.watched = ::pipe2(line.pipe.data(), O_NONBLOCK | O_CLOEXEC) == 0;
}

void FakeBoard::free(FakeLine& line) {
    const std::lock_guard lock(wires);
    line.user.clear();
    line.output = false;
    if (line.watched)
        for (const int end : line.pipe) ::close(end);
    line.watched = false;
    line.edges.clear();
}

void FakeBoard::drive(FakeLine& line, bool level) {
    const std::lock_guard lock(wires);
    line.rises += level && !line.level;
    line.level = level;
}

bool FakeBoard::is_high(const FakeLine& line) {
    const std::lock_guard lock(wires);
    return line.level;
}

int FakeBoard::rises_of(const FakeLine& line) {
    const std::lock_guard lock(wires);
    return line.rises;
}

void FakeBoard::turn(FakeLine& line, bool level, std::int64_t time_ns) {
    const std::lock_guard lock(wires);
    if (line.level == level) return;
    line.level = level;
    if (!line.watched || line.edges.size() == 16) return;
    line.edges.push_back({time_ns, level});
    (void)!::write(line.pipe[1], "", 1);
}

bool FakeBoard::pop(FakeLine& line, FakeEdge& edge) {
    const std::lock_guard lock(wires);
    char byte = 0;
    if (line.edges.empty() || ::read(line.pipe[0], &byte, 1) != 1) return false;
    edge = line.edges.front();
    line.edges.pop_front();
    return true;
}

}  // namespace lyr::tests
