// When in a layer each motion ends. A motion takes its length over its speed, a retraction its way over its speed, a
// dwell as long as it says; all that is then stretched to the layer's estimated duration, which knows of accelerations.
"use strict";

lyr.timing = (() => {
    const {kind} = lyr.motions;
    const unknownSpeed_mm_s = 50; // where the file states none

    // Of decoded layer: {ends_s (of each motion, from the layer's start), duration_s, raw_s}.
    function spread(layer, quantum_mm) {
        const {motions, head, events} = layer;
        const ends_s = new Float64Array(motions.count);
        let at_s = 0, depth_mm = head.retracted_mm, next = 0;
        for (let i = 0; i < motions.count; ++i) {
            for (; next < events.length && events[next].before <= i; ++next) {
                at_s += eventTime(events[next], head, depth_mm);
                depth_mm = events[next].depth_mm ?? depth_mm;
            }
            at_s += motionTime(motions, i, quantum_mm);
            ends_s[i] = at_s;
        }
        for (; next < events.length; ++next) {
            at_s += eventTime(events[next], head, depth_mm);
            depth_mm = events[next].depth_mm ?? depth_mm;
        }
        const duration_s = head.estimate_s > 0 ? head.estimate_s : at_s;
        const stretch = at_s > 0 ? duration_s / at_s : 0;
        for (let i = 0; i < ends_s.length; ++i) ends_s[i] *= stretch;
        return {ends_s, duration_s, raw_s: at_s};
    }

    function motionTime(motions, i, quantum_mm) {
        const speed = motions.styles[motions.style[i]].speed_mm_s || unknownSpeed_mm_s;
        return motions.length(i) * quantum_mm / speed;
    }

    function eventTime(event, head, depth_mm) {
        if (event.what === "dwell") return event.time_s;
        if (event.what !== "retract") return 0; // a wipe draws the filament back while it moves
        const way_mm = event.depth_mm - depth_mm;
        const speed = way_mm > 0 ? head.retractSpeed_mm_s : head.unretractSpeed_mm_s || head.retractSpeed_mm_s;
        return speed > 0 ? Math.abs(way_mm) / speed : 0;
    }

    // Before a layer was decoded: its estimate, or a guess from its ways.
    function roughDuration(head) {
        if (head.estimate_s > 0) return head.estimate_s;
        return head.extruded_mm / unknownSpeed_mm_s + head.travel_mm / (head.travelSpeed_mm_s || unknownSpeed_mm_s);
    }

    // How many motions are over at a time of the layer, and which share of the next one.
    function progress(ends_s, time_s) {
        let low = 0, high = ends_s.length;
        while (low < high) {
            const middle = low + high >> 1;
            if (ends_s[middle] <= time_s) low = middle + 1;
            else high = middle;
        }
        if (low === ends_s.length) return {done: low, share: 0};
        const begin_s = low > 0 ? ends_s[low - 1] : 0, span_s = ends_s[low] - begin_s;
        return {done: low, share: span_s > 0 ? Math.max(0, (time_s - begin_s) / span_s) : 0};
    }

    // Layers along the time of the print.
    class Schedule {
        constructor(heads) {
            this.durations_s = heads.map(roughDuration);
            this.update();
        }

        set(index, duration_s) {
            this.durations_s[index] = duration_s;
        }

        update() {
            this.begins_s = new Float64Array(this.durations_s.length + 1);
            for (let i = 0; i < this.durations_s.length; ++i)
                this.begins_s[i + 1] = this.begins_s[i] + this.durations_s[i];
            this.total_s = this.begins_s[this.durations_s.length];
        }

        layerAt(time_s) {
            const {done} = progress(this.begins_s.subarray(1), time_s);
            return Math.min(done, this.durations_s.length - 1);
        }
    }

    return {spread, progress, Schedule};
})();
