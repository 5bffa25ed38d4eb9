# Functions for the scripts that boot a guest; sourced. `here` is this folder.

# logged COMMAND...: shows what it says only where it fails.
logged() {
    "$@" > log 2>&1 || { cat log >&2; exit 1; }
}

# The print of all guests: 15 thick layers of a pulley with one wall; lines, arcs and retractions in 40 seconds.
slice_print() {
    logged "$1/stepc" "$here/../../fixtures/parts/transmission_pulley_at3_t10_center.step" -o print.lyr \
        --layer-height 0.6 --set nozzle.diameter=0.8 --set perimeters.count=1 --set infill.density=0% \
        --set skin.top_layers=0 --set skin.bottom_layers=0
}

# simulate LYRRUN OPTIONS: the same print on the same machine, as a wave.
simulate() {
    lyrrun=$1
    shift
    logged "$lyrrun" print.lyr --printer printer.toml --simulate "$@"
}

# start_guest BUSYBOX CASES NAME...: with the file CASES, of which the cases NAME are to run, and the print and
# printer.toml of the folder in which it is called.
start_guest() {
    rm -rf guest
    mkdir -p guest/bin guest/dev guest/proc guest/sys guest/modules
    cp "$1" guest/bin/busybox
    cp "$2" guest/cases
    cp "$here/init" print.lyr printer.toml guest
    shift 2
    echo "$@" > guest/wanted
}

# boot MACHINE OPTIONS: until the guest says that it is done. Its clock counts instructions, two nanoseconds each, and
# skips idle time: what is recorded does not depend on how fast or busy this machine is.
boot() {
    (cd guest && find . | cpio -o -H newc --quiet | gzip -1) > initramfs
    rm -f console
    machine=$1
    shift
    "$machine" -display none -no-reboot -icount shift=1,sleep=off -initrd initramfs -serial file:console \
        "$@" < /dev/null > qemu.log 2>&1 &
    qemu=$!
    trap 'kill $qemu 2> /dev/null' EXIT
    limit_s=900
    until grep -qs "^init: " console; do
        limit_s=$((limit_s - 1))
        [ $limit_s -gt 0 ] && kill -0 $qemu 2> /dev/null || break
        sleep 1
    done
    # Some machines stay when the guest has halted.
    kill $qemu 2> /dev/null || true
    wait $qemu 2> /dev/null || true
    trap - EXIT
    grep -q "^init: done" console && return
    tail -n 30 qemu.log console >&2
    echo "the guest did not finish" >&2
    exit 1
}
