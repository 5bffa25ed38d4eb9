#include "target/control/web/token.h"

#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>

#include "base/text.h"

namespace lyr::control {
namespace {

constexpr std::size_t most_token_bytes = 256;

Diagnostic problem(const std::string& path, const std::string& what,
                   ExitStatus status = ExitStatus::input) {
    return {Severity::error, status, what, {.file = path}};
}

Result<std::string> make(const std::string& path) {
    Result<std::string> token = random_token();
    if (!token) return token;
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    const std::string line = *token + '\n';
    const bool written =
        file >= 0 && ::write(file, line.data(), line.size()) == static_cast<ssize_t>(line.size());
    const int error = errno;
    if (file >= 0) ::close(file);
    if (written) return token;
    return problem(path, std::string("the token cannot be written: ") + std::strerror(error),
                   ExitStatus::output);
}

}  // namespace

Result<std::string> random_token() {
    std::array<unsigned char, 16> bytes;
    if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
        return Diagnostic{
            Severity::error, ExitStatus::internal, "the kernel gives no random numbers", {}};
    std::string token;
    for (const unsigned char byte : bytes) token += formatted("%02x", byte);
    return token;
}

Result<std::string> token_in(const std::string& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0 && errno == ENOENT) return make(path);
    if (file < 0) return problem(path, std::string("cannot be read: ") + std::strerror(errno));
    struct stat found {};
    std::array<char, most_token_bytes> bytes;
    const bool is_file = ::fstat(file, &found) == 0 && S_ISREG(found.st_mode);
    const ssize_t count = is_file ? ::read(file, bytes.data(), bytes.size()) : -1;
    ::close(file);
    if (count < 0) return problem(path, "the token must be in a file");
    if ((found.st_mode & 077) != 0)
        return problem(path, "others may read the token; make it yours alone: chmod 600");
    std::string token(bytes.data(), static_cast<std::size_t>(count));
    while (!token.empty() && std::isspace(static_cast<unsigned char>(token.back())))
        token.pop_back();
    if (token.size() < least_token_letters || count == static_cast<ssize_t>(bytes.size()))
        return problem(path, "a token has " + std::to_string(least_token_letters) + " to " +
                                 std::to_string(most_token_bytes - 1) + " letters");
    for (const char c : token)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_')
            return problem(path, "a token is made of letters, digits, - and _");
    return token;
}

bool is_token(std::string_view offered, std::string_view token) {
    // Every letter is looked at; volatile, lest the compiler finds out early.
    volatile unsigned difference = offered.size() != token.size();
    for (std::size_t i = 0; i < token.size(); ++i) {
        const char letter = i < offered.size() ? offered[i] : '\0';
        difference = difference | static_cast<unsigned char>(letter ^ token[i]);
    }
    return difference == 0;
}

}  // namespace lyr::control
