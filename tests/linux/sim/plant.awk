# What stands behind the simulated lines: a hotend and a bed that the heater lines warm, seen through thermistors (100 k,
# B 3950, 4.7 k to 3.3 V) by ADS1115 converters. Every tick the levels are read and the converters' registers written.
# The file /tmp/torn stands for a torn wire of the hotend's sensor.
# e^x, which this awk lacks: (1 + x / 2^20)^(2^20), within 2e-5 for the values here.
function power(x, i) {
    x = 1 + x / 1048576
    for (i = 0; i < 20; ++i) x *= x
    return x
}
function counts(celsius, ohm) {
    ohm = 100000 * power(3950 * (1 / (celsius + 273.15) - 1 / 298.15))
    # The least bit of a real converter is never quiet.
    return int(26400 * ohm / (ohm + 4700)) + ticks % 2
}
# SMBus words begin with the low byte, the converter's with the high one.
function register(counts) {
    return (counts % 256) * 256 + int(counts / 256)
}
function level(file, value) {
    getline value < file
    close(file)
    return value
}
function warm(celsius, on, watt, joule_per_kelvin, watt_per_kelvin) {
    return celsius + tick_s * (on * watt - watt_per_kelvin * (celsius - 25)) / joule_per_kelvin
}
BEGIN {
    tick_s = 0.1
    open_counts = 26400
    tool = bed = 25
    for (;;) {
        ++ticks
        torn = (getline line < "/tmp/torn") > 0
        close("/tmp/torn")
        words = "i2cset -f -y 0 0x48 0 " (torn ? register(open_counts) : register(counts(tool))) " w;"
        words = words "i2cset -f -y 0 0x49 0 " register(counts(bed)) " w;"
        system(words "usleep 100000")
        tool = warm(tool, level(tool_line), 40, 12, 0.1)
        bed = warm(bed, 1 - level(bed_line), 220, 250, 1.3)
    }
}
