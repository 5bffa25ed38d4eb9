// lyrctl's page from outside; tests/target/control/web has the page itself.

#include "apps/program.h"

using namespace lyr::tests;

TEST_CASE(
    "lyrctl: web tells its address and token, or keeps the token in a file; ends on request") {
    const Folder folder("lyrctl-web");
    const auto told = [&](const std::string& more) {
        // Its output goes to a file, since it does not end by itself.
        fs::remove(folder / "out");
        const Ended ended = folder.run("lyrctl web 0 --socket s " + more +
                                       " >out & while [ ! -s out ]; do sleep 0.02; done; kill $!; "
                                       "wait $!");
        CHECK(ended.status == 8);
        return text_of(folder / "out");
    };
    const std::string once = told(""), again = told("");
    CHECK(once.starts_with("http://127.0.0.1:"));
    CHECK(once.find("/#token=") != std::string::npos);
    CHECK(once.substr(once.find('#')) != again.substr(again.find('#')));
    CHECK(told("--token token").ends_with("/\n"));
    const std::string token = text_of(folder / "token");
    CHECK(token.size() == 33);
    CHECK(told("--token token").ends_with("/\n"));
    CHECK(text_of(folder / "token") == token);
    folder.write("open", "0123456789abcdef");
    check_failure(folder.run("chmod 644 open; lyrctl web 0 --token open"), "lyrctl", 3,
                  "chmod 600");
    check_failure(folder.run("mkdir t; lyrctl web 0 --token t"), "lyrctl", 3, "must be in a file");
}
