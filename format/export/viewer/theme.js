// The colours and letters of the page's style sheet, for what is drawn on a canvas.
"use strict";

lyr.theme = (() => {
    function read() {
        const style = getComputedStyle(document.documentElement);
        const of = (name) => style.getPropertyValue(`--${name}`).trim();
        const family = style.fontFamily;
        return {
            name: matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light",
            stage: of("stage"), card: of("card"), text: of("text"), faintText: of("faint"), ruling: of("ruling"),
            accent: of("accent"), travel: of("travel"), wipe: of("wipe"),
            stageRgb: lyr.colors.rgb(of("stage")), bedRgb: lyr.colors.rgb(of("bed")),
            travelRgb: lyr.colors.rgb(of("travel")),
            font: `12px ${family}`, strongFont: `600 12px ${family}`,
        };
    }

    return {read};
})();
