// libFuzzer target: whatever the bytes, reading them ends with a file or an error.

#include <cstdint>

#include "parser/part21/decode_all.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lyr::part21;
    const auto file = File::parse("fuzz.stp", {reinterpret_cast<const char*>(data), size});
    if (file) decode_all(*file);
    return 0;
}
