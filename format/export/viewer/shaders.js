// The programs on the graphics card. An instance is a line or an arc; its vertices are made here, along the true arc, in
// as many segments as the zoom asks for: as a ribbon bent towards the eye, so that neighbours meet where they
// should, where strands are a few pixels wide, and as a
// tube with the strand's section where they are wider.
"use strict";

lyr.shaders = (() => {
    const strandVertex = `#version 300 es
precision highp float;
precision highp int;
layout(location = 0) in vec3 a_from;
layout(location = 1) in vec3 a_to;
layout(location = 2) in float a_quarter;   // tangent of a quarter of the turn
layout(location = 3) in uint a_section;    // width and height, um
layout(location = 4) in uint a_style;
layout(location = 5) in uint a_layer;
uniform mat4 u_matrix;
uniform vec3 u_eye;
uniform int u_segments;
uniform int u_sides;          // 0: a ribbon
uniform float u_pixel;        // size of a pixel at distance 1
uniform float u_least_px;     // no strand is thinner
uniform float u_tall;         // times as high as they are
uniform bool u_by_layer;
uniform highp sampler2D u_style_colors;
uniform highp sampler2D u_layer_colors;
out vec3 v_normal;
flat out vec3 v_color;

vec4 entry(highp sampler2D table, uint number) {
    return texelFetch(table, ivec2(int(number & 1023u), int(number >> 10)), 0);
}

void main() {
    vec4 color = entry(u_style_colors, a_style);
    v_color = u_by_layer && color.a > 0.75 ? entry(u_layer_colors, a_layer).rgb : color.rgb;
    int ring, side;
    if (u_sides == 0) {
        // Two strips, left and right of the ridge, with two vertices between them that make no triangle.
        int strip = 2 * (u_segments + 1);
        int at_vertex = gl_VertexID <= strip ? min(gl_VertexID, strip - 1) : max(gl_VertexID - strip - 2, 0);
        bool right = gl_VertexID > strip;
        ring = at_vertex >> 1;
        side = (at_vertex & 1) + (right ? 1 : 0);   // left edge, ridge, right edge
    } else {
        int quad = gl_VertexID / 6, corner = gl_VertexID - 6 * quad;
        bool ahead = corner == 1 || corner == 2 || corner == 4;
        bool beside = corner == 2 || corner == 4 || corner == 5;
        ring = quad / u_sides + (ahead ? 1 : 0);
        side = quad % u_sides + (beside ? 1 : 0);
    }
    // Two rings in front and behind make the ends round.
    int inner = clamp(ring - (u_sides == 0 ? 0 : 2), 0, u_segments);
    float share = float(inner) / float(u_segments);
    int beyond = u_sides == 0 ? 0 : ring < 2 ? ring - 2 : max(0, ring - 2 - u_segments);

    vec2 chord = a_to.xy - a_from.xy;
    float length_mm = length(chord);
    float turn = 4.0 * atan(a_quarter);
    float base = length_mm > 0.0 ? atan(chord.y, chord.x) : 0.0;
    vec3 at = mix(a_from, a_to, share);
    float heading = base - turn * (0.5 - share);
    if (abs(a_quarter) > 1e-5) {
        float half_turn = 0.5 * turn * share;
        float reach = length_mm * (1.0 + a_quarter * a_quarter) / (2.0 * a_quarter) * sin(half_turn);
        float direction = base - 0.5 * turn + half_turn;
        at.xy = a_from.xy + reach * vec2(cos(direction), sin(direction));
    }
    vec3 along = vec3(cos(heading), sin(heading), 0.0);
    if (length_mm == 0.0) along = vec3(0.0, 0.0, sign(a_to.z - a_from.z));
    vec3 across = length_mm > 0.0 ? vec3(-along.y, along.x, 0.0) : vec3(1.0, 0.0, 0.0);
    vec3 up = cross(along, across);

    float width = float(a_section & 0xffffu) * 1e-3, height = float(a_section >> 16) * 1e-3 * u_tall;
    at.z -= 0.5 * height; // the nozzle is at the top of the strand
    vec3 to_eye = u_eye - at;
    float least = u_least_px * u_pixel * length(to_eye);
    width = max(width, least);
    height = max(height, 0.5 * least);
    vec3 place;
    if (u_sides == 0) {
        vec3 beside = cross(along, to_eye);
        float size = length(beside);
        beside = size > 0.0 ? beside / size : across;
        vec3 face = normalize(cross(beside, along));
        if (dot(face, to_eye) < 0.0) face = -face;
        vec2 half_size = 0.5 * vec2(width, height);
        vec3 off = side == 1 ? face : float(side - 1) * beside;
        vec2 section = vec2(dot(off, across), dot(off, up));
        place = at + length(half_size * section) * off;
        float cap = ring == 0 ? -1.0 : ring == u_segments ? 1.0 : 0.0;
        place += cap * 0.3 * width * along;
        // Where strands are a pixel or two, their roundness is not seen but would flicker: there walls are lit as the
        // surface that they make, which stands upright, and all else as one that lies.
        float relief = clamp(width / (10.0 * u_pixel * length(to_eye)) - 0.3, 0.0, 1.0);
        vec2 slope = section / (half_size * half_size);
        vec3 own = normalize(normalize(slope.x * across + slope.y * up) + 0.5 * face);
        bool upright = color.a > 0.95;
        vec3 surface = upright ? sign(dot(across, to_eye)) * across + 0.4 * up : sign(to_eye.z) * up;
        v_normal = normalize(mix(normalize(surface), own, relief));
    } else {
        // A rectangle with round sides.
        float angle = 6.2831853 * (float(side) + 0.5) / float(u_sides);
        vec2 round_part = vec2(cos(angle), sin(angle));
        float flat_part = 0.5 * max(0.0, width - height);
        vec2 section = 0.5 * vec2(min(width, height), height) * round_part + vec2(flat_part * sign(round_part.x), 0.0);
        float ends = float(beyond) * 0.5, shrink = sqrt(max(0.0, 1.0 - ends * ends));
        place = at + shrink * (section.x * across + section.y * up) + 0.5 * min(width, 2.0 * height) * ends * along;
        v_normal = normalize(round_part.x * across + round_part.y * up + 1.5 * ends * along);
    }
    gl_Position = color.a > 0.0 ? u_matrix * vec4(place, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}`;

    const strandFragment = `#version 300 es
precision highp float;
in vec3 v_normal;
flat in vec3 v_color;
uniform vec3 u_light;     // towards the light
uniform float u_shade;    // 0: flat
out vec4 o_color;
void main() {
    vec3 normal = normalize(v_normal);
    float light = 0.62 + 0.42 * max(0.0, dot(normal, u_light)) + 0.08 * normal.z;
    o_color = vec4(v_color * mix(1.0, light, u_shade), 1.0);
}`;

    // Thin lines of one colour: the bed.
    const lineVertex = `#version 300 es
layout(location = 0) in vec3 a_at;
uniform mat4 u_matrix;
void main() {
    gl_Position = u_matrix * vec4(a_at, 1.0);
}`;
    const lineFragment = `#version 300 es
precision mediump float;
uniform vec4 u_color;
out vec4 o_color;
void main() {
    o_color = u_color;
}`;

    return {strandVertex, strandFragment, lineVertex, lineFragment};
})();
