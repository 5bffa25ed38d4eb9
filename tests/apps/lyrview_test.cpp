// The program itself: what it prints where, and its exit status. docs/exit-status.md is its contract.

#include "apps/with_print.h"

using namespace lyr;
using namespace lyr::tests;

TEST_CASE("lyrview: the picture is the same in a file, on standard output and by either name") {
    const Folder folder = with_print("lyrview-picture");
    const Ended named = folder.run("lyrview a.lyr --layer 2 -o 2.svg");
    CHECK(named.status == 0);
    CHECK(named.out.empty());
    const std::string picture = text_of(folder / "2.svg");
    CHECK(picture.find("<svg") != std::string::npos);
    for (const char* script :
         {"lyrview a.lyr --layer 2", "lyrview a.lyr --layer 2 -o -", "lyrview - --layer 2 < a.lyr",
          "cat a.lyr | lyrview - --layer 2 -o /dev/stdout"}) {
        CAPTURE(script);
        const Ended ended = folder.run(script);
        CHECK(ended.status == 0);
        CHECK(ended.out == picture);
        CHECK(ended.err.empty());
    }
    CHECK(folder.run("lyrview a.lyr --layer 2 -o - > new.svg").status == 0);
    CHECK(text_of(folder / "new.svg") == picture);
}

TEST_CASE("lyrview: a page is whole, the same from a file and a pipe, and carries the print") {
    const Folder folder = with_print("lyrview-page");
    CHECK(folder.run("lyrview a.lyr -o a.html").status == 0);
    const std::string page = text_of(folder / "a.html");
    CHECK(page.starts_with("<!DOCTYPE html>"));
    CHECK(page.ends_with("</html>\n"));
    for (const char* place : {"@title@", "@styles@", "@print@", "@scripts@"})
        CHECK(page.find(place) == std::string::npos);
    for (const char* address : {"src=", "url(", "import "})
        CHECK(page.find(address) == std::string::npos);
    CHECK(folder.run("lyrview - -o b.html < a.lyr").status == 0);
    CHECK(text_of(folder / "b.html") == page);
    CHECK(folder.run("cat a.lyr | lyrview - -o c.htm").status == 0);
    CHECK(text_of(folder / "c.htm") == page);
    const std::string mark = "id=\"print-file\">";
    const std::size_t begin = page.find(mark) + mark.size();
    folder.write("a.base64", page.substr(begin, page.find('<', begin) - begin));
    CHECK(folder.run("base64 -d a.base64 | cmp - a.lyr").status == 0);
}

TEST_CASE("lyrview: a page of a print that is not whole is refused, and none is left") {
    const Folder folder = with_print("lyrview-page-cut");
    const std::string whole = text_of(folder / "a.lyr");
    folder.write("cut.lyr", whole.substr(0, whole.size() - 40));
    check_lyrview_failure(folder.run("lyrview cut.lyr -o x.html"), 3, "cut.lyr");
    check_lyrview_failure(folder.run("lyrview missing.lyr -o x.html"), 3, "missing.lyr");
    check_lyrview_failure(folder.run("lyrview a.lyr -o missing/x.html"), 6, "missing/x.html");
    check_lyrview_failure(folder.run("lyrview a.lyr --no-travel -o x.html"), 2,
                          "--no-travel needs");
    fs::create_symlink("a.lyr", folder / "link.html");
    check_lyrview_failure(folder.run("lyrview a.lyr -o link.html"), 2,
                          "the page would overwrite the print");
    CHECK(text_of(folder / "a.lyr") == whole);
    CHECK_FALSE(fs::exists(folder / "x.html"));
}

TEST_CASE("lyrview: --info sums up and names the file, or standard input") {
    const Folder folder = with_print("lyrview-info");
    const Ended named = folder.run("lyrview a.lyr --info");
    CHECK(named.status == 0);
    CHECK(named.out.starts_with("a.lyr: .lyr 1."));
    const Ended stream = folder.run("lyrview - --info < a.lyr");
    CHECK(stream.status == 0);
    CHECK(stream.out.starts_with("standard input: .lyr 1."));
}

TEST_CASE("lyrview: what is wrong comes as one line and with its status") {
    const Folder folder = with_print("lyrview-wrong");
    check_lyrview_failure(folder.run("lyrview"), 2, "print");
    check_lyrview_failure(folder.run("lyrview a.lyr"), 2, "--info, --layer N");
    check_lyrview_failure(folder.run("lyrview a.lyr --info --layer 1"), 2, "--info or --layer");
    check_lyrview_failure(folder.run("lyrview a.lyr --info -o x"), 2, "--layer");
    check_lyrview_failure(folder.run("lyrview a.lyr --info -o -"), 2, "--layer");
    check_lyrview_failure(folder.run("lyrview '' --info"), 2, "print: expected the name of a file");
    check_lyrview_failure(folder.run("lyrview a.lyr --layer 1 -o ''"), 2,
                          "expected the name of a file");
    check_lyrview_failure(folder.run("lyrview a.lyr --layer 4"), 3, "3 layers");
    check_lyrview_failure(folder.run("lyrview missing.lyr --info"), 3, "missing.lyr");
    for (const char* layer : {"0", "-1", "nan", "inf", "1e1", "1.5", "99999999999", "''", "x"}) {
        CAPTURE(layer);
        check_lyrview_failure(folder.run("lyrview a.lyr --layer " + std::string(layer)), 2,
                              "--layer: expected a whole number from 1");
    }
    CHECK(folder.files() == std::set<std::string>{"a.lyr"});
}

TEST_CASE("lyrview: the picture never takes the place of the print") {
    const Folder folder = with_print("lyrview-files");
    const std::string before = text_of(folder / "a.lyr");
    fs::create_symlink("a.lyr", folder / "link");
    for (const char* output : {"a.lyr", "link", "$PWD/./a.lyr"})
        check_lyrview_failure(folder.run("lyrview a.lyr --layer 1 -o " + std::string(output)), 2,
                              "the picture would overwrite the print");
    check_lyrview_failure(folder.run("lyrview a.lyr --layer 1 >> a.lyr"), 2, "standard output");
    CHECK(text_of(folder / "a.lyr") == before);
}

TEST_CASE(
    "lyrview: a whole layer of a file that is cut short is drawn, from a file as from a pipe") {
    const Folder folder = with_print("lyrview-cut");
    const std::string whole = text_of(folder / "a.lyr");
    folder.write("cut.lyr", whole.substr(0, whole.size() - 40));
    for (const char* ending : {"svg", "dxf"}) {
        const std::string command = std::string(" --layer 2 -o - --to ") + ending;
        const Ended drawn = folder.run("lyrview a.lyr" + command);
        CHECK(drawn.status == 0);
        for (const char* cut : {"lyrview cut.lyr", "cat cut.lyr | lyrview -"}) {
            const Ended again = folder.run(cut + command);
            CHECK(again.status == 0);
            CHECK(again.out == drawn.out);
        }
    }
    for (const char* layer : {"3", "4"})
        check_lyrview_failure(folder.run("lyrview cut.lyr -o x.svg --layer " + std::string(layer)),
                              3, "the last whole layer is 3");
    check_lyrview_failure(folder.run("lyrview cut.lyr --info"), 3, "the last whole layer is 3");
    CHECK_FALSE(fs::exists(folder / "x.svg"));
}

TEST_CASE("lyrview: a link as output stays, also one to a file that is not there yet") {
    const Folder folder = with_print("lyrview-link");
    fs::create_symlink("2.svg", folder / "link");
    CHECK(folder.run("lyrview a.lyr --layer 2 -o link").status == 0);
    CHECK(fs::is_symlink(folder / "link"));
    CHECK(text_of(folder / "2.svg").find("<svg") != std::string::npos);
}

TEST_CASE("lyrview: output that cannot be written is status 6 and says why") {
    const Folder folder = with_print("lyrview-full");
    check_lyrview_failure(folder.run("lyrview a.lyr --layer 3 -o /dev/full"), 6,
                          "No space left on device");
    check_lyrview_failure(folder.run("lyrview a.lyr --layer 3 >/dev/full"), 6,
                          "No space left on device");
    check_lyrview_failure(folder.run("lyrview a.lyr --info >/dev/full"), 6,
                          "No space left on device");
    check_lyrview_failure(folder.run("lyrview a.lyr --info >&-"), 6, "standard output");
    check_lyrview_failure(folder.run("lyrview a.lyr --layer 3 -o missing/x.svg"), 6,
                          "missing/x.svg");
}

TEST_CASE("lyrview: a signal ends it with status 8 while it waits for its input") {
    const Folder folder("lyrview-signal");
    folder.make_pipe("pipe");
    for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
        const Running running(folder, {"lyrview", "pipe", "--info"}, folder / "err");
        CHECK(running.wait_for([&] { return running.blocks(signal); }));
        CHECK(running.end(signal) == 8);
        CHECK(text_of(folder / "err") == "lyrview: error: stopped on request\n");
    }
}
