#include <stdio.h>

#include "lyr.h"

static int32_t read_file(void* user, uint8_t* bytes, uint32_t count) {
    FILE* file = user;
    const size_t got = fread(bytes, 1, count, file);
    return ferror(file) ? -1 : (int32_t)got;
}

static const char* const wrong[] = {
    [LYR_UNREADABLE] = "cannot read", [LYR_CUT_SHORT] = "cut short",
    [LYR_NO_LYR] = "no .lyr file",    [LYR_DAMAGED] = "damaged",
    [LYR_UNSUPPORTED] = "too new",    [LYR_TOO_LONG] = "a block is too long",
    [LYR_NONSENSE] = "makes no sense"};

int main(int count, char** arguments) {
    static uint8_t buffer[65536];
    static lyr_reader reader;
    FILE* file = count == 2 ? fopen(arguments[1], "rb") : NULL;
    if (!file) return 2;
    const lyr_source source = {.read = read_file, .user = file};
    lyr_operation operation;
    lyr_open(&reader, &source, buffer, sizeof buffer);
    while (lyr_next(&reader, &operation)) {
        if (operation.kind == LYR_LAYER)
            printf("layer %u: up to z = %.3f mm\n", (unsigned)operation.number + 1,
                   operation.to.z * (reader.quantum_nm / 1e6));
    }
    fclose(file);
    if (reader.status == LYR_END) return 0;
    printf("%s at byte %llu; the last whole layer is %u\n", wrong[reader.status],
           (unsigned long long)reader.offset, (unsigned)reader.whole_layers);
    return 1;
}
