// Numbers as people read them.
"use strict";

lyr.words = (() => {
    function fixed(value, digits) {
        return value.toFixed(digits);
    }

    // 1 234.5 with as many digits as tell something.
    function number(value) {
        const digits = Math.abs(value) >= 100 ? 0 : Math.abs(value) >= 10 ? 1 : 2;
        return value.toFixed(digits).replace(/\B(?=(\d{3})+(?!\d))/g, "\u202f");
    }

    function count(value) {
        return String(value).replace(/\B(?=(\d{3})+(?!\d))/g, "\u202f");
    }

    function length(mm) {
        return mm >= 10000 ? `${number(mm / 1000)} m` : `${number(mm)} mm`;
    }

    function volume(mm3) {
        return mm3 >= 1000 ? `${number(mm3 / 1000)} cm³` : `${number(mm3)} mm³`;
    }

    // 1:02:03, 2:03, 4.5 s
    function time(s) {
        if (s < 10) return `${s.toFixed(1)} s`;
        const whole = Math.round(s), two = (value) => String(value).padStart(2, "0");
        const hours = Math.floor(whole / 3600), minutes = Math.floor(whole / 60) % 60;
        return hours > 0 ? `${hours}:${two(minutes)}:${two(whole % 60)}` : `${minutes}:${two(whole % 60)}`;
    }

    function size(bytes) {
        return bytes >= 1e6 ? `${number(bytes / 1e6)} MB` : `${number(bytes / 1e3)} kB`;
    }

    function capital(text) {
        return text[0].toUpperCase() + text.slice(1);
    }

    return {fixed, number, count, length, volume, time, size, capital};
})();
