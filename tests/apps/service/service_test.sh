#!/bin/sh
# Installs the service's files into a folder and has systemd's own programs check them, those that are there.
#
#   service_test.sh BUILD
set -eu
build=$1
prefix=$build/test-apps/service
rm -rf "$prefix"
mkdir -p "$prefix/bin"
cmake --install "$build" --component service --prefix "$prefix" >"$prefix/log"
ln -s "$build/lyrrun" "$build/lyrctl" "$prefix/bin"

fail() {
    echo "service_test: $1" >&2
    exit 1
}
[ -f "$prefix/lib/udev/rules.d/60-lyr.rules" ] || fail "the rules are not installed"
units=$prefix/lib/systemd/system
grep -q "^ExecStart=$prefix/bin/lyrrun %f " "$units/lyrrun@.service" || fail "the unit starts something else"
# With another the keeper of the heaters' lines is killed where the print crashes, before it has switched them off.
grep -q "^KillMode=process$" "$units/lyrrun@.service" || fail "the unit kills the keeper of the heaters' lines"
# Nobody else switches heaters off where both processes of a print were killed.
grep -q "^ExecStopPost=-$prefix/bin/lyrrun .*--off$" "$units/lyrrun@.service" || fail "the unit leaves heaters on"

checked=no
if command -v systemd-analyze >/dev/null; then
    checked=yes
    ln -s "lyrrun@.service" "$units/lyrrun@tmp-part.lyr.service"
    for unit in lyrrun@tmp-part.lyr.service lyr-page.service; do
        said=$(systemd-analyze verify --man=no "$units/$unit" 2>&1) || fail "$said"
        [ -z "$said" ] || fail "$said"
        # 0 is locked up, 10 wide open, in tenths.
        systemd-analyze security --offline=true --threshold=30 "$units/$unit" >"$prefix/security" ||
            fail "$(tail -1 "$prefix/security")"
    done
fi
if command -v systemd-sysusers >/dev/null; then
    checked=yes
    systemd-sysusers --dry-run "$prefix/lib/sysusers.d/lyr.conf" >"$prefix/users" 2>&1 || fail "$(cat "$prefix/users")"
fi
# From systemd 254 on.
if command -v udevadm >/dev/null && udevadm verify --help >/dev/null 2>&1; then
    checked=yes
    udevadm verify "$prefix/lib/udev/rules.d/60-lyr.rules" >"$prefix/rules" 2>&1 || fail "$(cat "$prefix/rules")"
fi
[ $checked = yes ] || exit 77
