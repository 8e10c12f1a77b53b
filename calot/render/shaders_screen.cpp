#include "calot/render/shaders.h"

namespace calot::render::shaders {

// Obscurance from depth (after McGuire et al. 2011, "The Alchemy screen-space ambient obscurance algorithm"), at half
// the size: how much of the half-space above a point is taken by nearby surfaces.
const char* const kOcclusionFragment = R"(
in vec2 v_uv;
uniform sampler2D u_depth;
out vec4 o_colour;
vec3 place(vec2 uv) {
    float z = axial_m(texture(u_depth, uv).r);
    return vec3((2.0 * uv - 1.0) * u_projection.xy * z, -z);
}
void main() {
    vec2 round_at = (2.0 * v_uv - 1.0) / u_round.xy;
    if (dot(round_at, round_at) > 1.02) { o_colour = vec4(1.0); return; }
    vec3 p = place(v_uv);
    vec2 step = 2.0 * u_pixels.zw;
    // One-sided differences towards the nearer neighbour, so that edges stay clean.
    vec3 dx1 = place(v_uv + vec2(step.x, 0.0)) - p, dx0 = p - place(v_uv - vec2(step.x, 0.0));
    vec3 dy1 = place(v_uv + vec2(0.0, step.y)) - p, dy0 = p - place(v_uv - vec2(0.0, step.y));
    vec3 n = normalize(cross(abs(dx1.z) < abs(dx0.z) ? dx1 : dx0, abs(dy1.z) < abs(dy0.z) ? dy1 : dy0));
    float reach = 0.006;   // m
    vec2 scale = reach / (-p.z * 2.0 * u_projection.xy);
    float turn = 6.2831853 * fract(52.9829189 * fract(dot(floor(gl_FragCoord.xy), vec2(0.06711056, 0.00583715))));
    float sum = 0.0;
    for (int k = 0; k < OCCLUSION_SAMPLES; ++k) {
        float r = (float(k) + 0.5) / float(OCCLUSION_SAMPLES);
        float angle = turn + 15.08 * r;
        vec3 v = place(v_uv + r * scale * vec2(cos(angle), sin(angle))) - p;
        float d2 = dot(v, v);
        float fade = max(0.0, 1.0 - d2 / (reach * reach));
        sum += fade * fade * max(0.0, dot(v, n) - 0.00012) / (d2 + 1.0e-6);
    }
    float open = max(0.0, 1.0 - 0.0042 * sum / float(OCCLUSION_SAMPLES));
    o_colour = vec4(open * open, 0.0, 0.0, 1.0);
}
)";

const char* const kOcclusionBlurFragment = R"(
in vec2 v_uv;
uniform sampler2D u_source;
uniform sampler2D u_depth;
out vec4 o_colour;
void main() {
    vec2 texel = 2.0 * u_pixels.zw;
    float z = axial_m(texture(u_depth, v_uv).r);
    float sum = 0.0, weight = 0.0;
    for (int y = -1; y <= 2; ++y)
        for (int x = -1; x <= 2; ++x) {
            vec2 uv = v_uv + (vec2(float(x), float(y)) - 0.5) * texel;
            float w = max(0.02, 1.0 - abs(axial_m(texture(u_depth, uv).r) - z) / 0.003);
            sum += w * texture(u_source, uv).r;
            weight += w;
        }
    o_colour = vec4(sum / weight, 0.0, 0.0, 1.0);
}
)";

// A quarter of the size: what is bright enough to bleed (rgb).
const char* const kBrightFragment = R"(
in vec2 v_uv;
uniform sampler2D u_scene;
uniform sampler2D u_smoke;
out vec4 o_colour;
void main() {
    vec3 sum = vec3(0.0);
    for (int k = 0; k < 4; ++k) {
        vec2 uv = v_uv + (vec2(float(k & 1), float(k >> 1)) * 2.0 - 1.0) * u_pixels.zw;
        vec3 colour = min(decode(texture(u_scene, uv).rgb), vec3(12.0));
        sum += max(colour - 0.85, 0.0);
    }
    float clear = 1.0 - texture(u_smoke, v_uv).a;
    o_colour = vec4(encode(0.25 * sum * clear), 1.0);
}
)";

const char* const kBlurFragment = R"(
in vec2 v_uv;
uniform sampler2D u_source;
uniform vec2 u_step;
out vec4 o_colour;
void main() {
    vec3 sum = 0.2270 * decode(texture(u_source, v_uv).rgb);
    sum += 0.3162 * (decode(texture(u_source, v_uv + 1.3846 * u_step).rgb) + decode(texture(u_source, v_uv - 1.3846 * u_step).rgb));
    sum += 0.0703 * (decode(texture(u_source, v_uv + 3.2308 * u_step).rgb) + decode(texture(u_source, v_uv - 3.2308 * u_step).rgb));
    o_colour = vec4(encode(sum), 1.0);
}
)";

// The camera: barrel distortion, smoke over the scene, bloom, depth of field, filmic curve, vignette. Alpha = luma for
// the finish.
const char* const kComposeFragment = R"(
in vec2 v_uv;
uniform sampler2D u_scene;
uniform sampler2D u_smoke;
uniform sampler2D u_bloom;
uniform sampler2D u_depth;
out vec4 o_colour;

uniform sampler3D u_smooth;
uniform sampler3D u_bump;

float noise(vec2 at) { return fract(52.9829189 * fract(dot(at, vec2(0.06711056, 0.00583715)))); }

// Eight looks around a place, as through a lens that scatters.
vec3 scattered(vec2 uv, float reach) {
    vec3 sum = vec3(0.0);
    for (int k = 0; k < 8; ++k) {
        float angle = 0.785398 * float(k) + 0.4;
        vec2 at = uv + reach * (0.5 + 0.5 * float(k & 1)) * vec2(cos(angle) * u_pixels.y * u_pixels.z, sin(angle));
        sum += decode(texture(u_scene, clamp(at, 0.002, 0.998)).rgb);
    }
    return 0.125 * sum;
}

void main() {
    vec2 round_at = (2.0 * v_uv - 1.0) / u_round.xy;
    float r2 = dot(round_at, round_at);
    if (r2 > 1.0) { o_colour = vec4(0.0, 0.0, 0.0, 0.0); return; }
    // Drops and film on the front lens bend what is behind them.
    float smeared = 0.0;
    vec2 bent = vec2(0.0);
    if (u_lens.y > 0.0) {
        vec4 film = texture(u_smooth, vec3(0.45 * round_at, u_lens.z));
        vec4 grease = texture(u_bump, vec3(0.30 * round_at.yx, u_lens.z + 0.37));
        smeared = smoothstep(0.62 - 0.34 * u_lens.y, 0.74 - 0.20 * u_lens.y, film.r);
        bent = smeared * u_lens.y * 0.035 * (grease.rg - 0.5 + 2.0 * (film.gb - 0.5));
    }
    float k = u_round.z;
    vec2 uv = 0.5 + 0.5 * round_at * ((1.0 + k * r2) / (1.0 + k)) * u_round.xy;
    uv += bent;
    vec3 colour = decode(texture(u_scene, uv).rgb);
#if QUALITY > 0
    // Out of focus in front of and behind the target: a ring of neighbours.
    float z = axial_m(texture(u_depth, uv).r);
    float blur = clamp(abs(u_axis.w / z - 1.0) * 2.2 - 0.30, 0.0, 1.4) * u_pixels.y / 400.0;
    vec2 texel = blur * u_pixels.zw;
    vec3 ring = decode(texture(u_scene, uv + texel * vec2(0.9, 0.4)).rgb) + decode(texture(u_scene, uv + texel * vec2(-0.4, 0.9)).rgb) +
                decode(texture(u_scene, uv + texel * vec2(-0.9, -0.4)).rgb) + decode(texture(u_scene, uv + texel * vec2(0.4, -0.9)).rgb);
    colour = 0.2 * (colour + ring);
#endif
    vec4 smoke = texture(u_smoke, uv);
#ifdef HDR
    colour = colour * (1.0 - smoke.a) + smoke.rgb;
#else
    colour = decode(encode(colour) * (1.0 - smoke.a) + smoke.rgb);
#endif
#if QUALITY > 0
    colour += 0.16 * decode(texture(u_bloom, uv).rgb);
#endif
    if (u_lens.x > 0.0 || smeared > 0.0) {
        // Condensation comes from the rim; grease is uneven. Both scatter, and lift the blacks.
        float cloud = texture(u_smooth, vec3(0.8 * round_at, 0.5 + u_lens.z)).r;
        float fog = clamp(u_lens.x * (0.75 + 0.45 * r2 + 1.1 * (cloud - 0.5)), 0.0, 0.97);
        float dim = clamp(fog + 0.75 * smeared * min(1.0, 1.4 * u_lens.y), 0.0, 0.97);
        colour = mix(colour, scattered(uv, 0.012 + 0.05 * dim), smoothstep(0.0, 0.45, dim));
        colour = mix(colour, vec3(0.36, 0.31, 0.29), 0.80 * fog * fog + 0.15 * fog);
        colour *= 1.0 - 0.35 * smeared * u_lens.y * vec3(0.6, 0.8, 1.0);
    }
    // Filmic curve (Narkowicz 2015, after ACES), a little warm.
    colour *= vec3(1.05, 1.0, 0.96) * 0.95;
    colour *= 1.0 - 0.45 * r2 * r2;
    colour = clamp(colour * (2.51 * colour + 0.03) / (colour * (2.43 * colour + 0.59) + 0.125), 0.0, 1.0);
    float edge = 1.0 - smoothstep(0.955, 1.0, sqrt(r2));
    colour = pow(colour, vec3(1.0 / 2.2)) * edge;
#if QUALITY == 0
    colour += (noise(gl_FragCoord.xy + 5.588 * float(u_counts.y)) - 0.5) * 0.020 * edge;
#endif
#if QUALITY == 0
    o_colour = vec4(colour, 1.0);   // the picture itself
#else
    o_colour = vec4(colour, dot(colour, vec3(0.30, 0.59, 0.11)));
#endif
}
)";

// Smooths stair-steps where luma jumps (after Lottes 2009, FXAA, its short form), sharpens as video cameras do, adds
// the sensor's noise.
const char* const kFinishFragment = R"(
in vec2 v_uv;
uniform sampler2D u_source;
uniform vec4 u_size;   // of the source: size, 1 / size
out vec4 o_colour;
float noise(vec2 at) { return fract(52.9829189 * fract(dot(at, vec2(0.06711056, 0.00583715)))); }
void main() {
    vec2 texel = u_size.zw;
    vec4 middle = texture(u_source, v_uv);
    float nw = texture(u_source, v_uv + vec2(-0.5, 0.5) * texel * 2.0).a, ne = texture(u_source, v_uv + texel).a;
    float sw = texture(u_source, v_uv - texel).a, se = texture(u_source, v_uv + vec2(0.5, -0.5) * texel * 2.0).a;
    float low = min(middle.a, min(min(nw, ne), min(sw, se))), high = max(middle.a, max(max(nw, ne), max(sw, se)));
    vec3 colour = middle.rgb;
    vec2 along = vec2(-((nw + ne) - (sw + se)), (nw + sw) - (ne + se));
    float least = 1.0 / (min(abs(along.x), abs(along.y)) + max((nw + ne + sw + se) * 0.03125, 0.0078));
    along = clamp(along * least, -6.0, 6.0) * texel;
    if (high - low > max(0.04, high * 0.12)) {
        vec3 near = 0.5 * (texture(u_source, v_uv - along / 6.0).rgb + texture(u_source, v_uv + along / 6.0).rgb);
        vec3 wide = 0.5 * near + 0.25 * (texture(u_source, v_uv - 0.5 * along).rgb + texture(u_source, v_uv + 0.5 * along).rgb);
        float luma = dot(wide, vec3(0.30, 0.59, 0.11));
        colour = luma < low || luma > high ? near : wide;
    }
    colour += 0.22 * (middle.a - 0.25 * (nw + ne + sw + se)) * step(0.02, middle.a);
    float grain = noise(gl_FragCoord.xy + 5.588 * float(u_counts.y)) + noise(gl_FragCoord.yx + 3.17 * float(u_counts.y)) - 1.0;
    colour += grain * 0.012 * step(0.01, middle.a);
    o_colour = vec4(clamp(colour, 0.0, 1.0), 1.0);
}
)";

}  // namespace calot::render::shaders
