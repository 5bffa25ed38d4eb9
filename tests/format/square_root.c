// Opens the C reader's square root for a test.

#include "format/c/lyr.c"

double lyr_square_root(double value);

double lyr_square_root(double value) {
    return square_root(value);
}
