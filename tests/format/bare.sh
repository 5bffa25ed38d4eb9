#!/bin/sh
# Is the C reader all that a board needs: built without a library, it asks for nothing but what compilers
# call by themselves, and holds no data that changes.
#   bare.sh <compiler> <lyr.c> <folder for the object>
set -eu
"$1" -std=c99 -O2 -Wall -Wextra -Wconversion -Wshadow -pedantic -Werror -ffreestanding -nostdlib \
    -c "$2" -o "$3/lyr_bare.o"
if nm -u "$3/lyr_bare.o" | grep -vE ' (memcpy|memmove|memset|memcmp)$'; then
    echo "bare: the symbols above are wanted" >&2
    exit 1
fi
if nm "$3/lyr_bare.o" | grep -iE ' [bdc] '; then
    echo "bare: the symbols above are data that changes" >&2
    exit 1
fi
