//! Butterflies of the fast Fourier transform of every radix: the slot `smoothing/radix`.
//!
//! A radix of two, four or eight is one transform of `shaders/smoothing/fourier.wgsl`. A larger one, A·B, is B transforms of every B-th leg
//! and A transforms of what comes of them, multiplied by roots of unity in between.

use std::f64::consts::TAU;
use std::fmt::Write as _;

/// A number of legs, its name, the transforms in a row, and whether more than one pass may use it.
struct Radix {
    name: &'static str,
    legs: usize,
    /// Legs of the first transforms and of the second ones.
    factors: Option<[usize; 2]>,
    /// Whether legs are turned between two passes along a line.
    turns: bool,
}

/// The most lanes of a workgroup whose lanes share butterflies, as the plan has it.
const LANES: usize = 64;

const RADICES: [Radix; 12] = [
    Radix { name: "two", legs: 2, factors: None, turns: false },
    Radix { name: "four", legs: 4, factors: None, turns: false },
    Radix { name: "six", legs: 6, factors: Some([2, 3]), turns: true },
    Radix { name: "eight", legs: 8, factors: None, turns: true },
    Radix { name: "ten", legs: 10, factors: Some([2, 5]), turns: true },
    Radix { name: "twelve", legs: 12, factors: Some([4, 3]), turns: true },
    Radix { name: "sixteen", legs: 16, factors: Some([4, 4]), turns: true },
    Radix { name: "twenty", legs: 20, factors: Some([4, 5]), turns: true },
    Radix { name: "twenty_four", legs: 24, factors: Some([8, 3]), turns: false },
    Radix { name: "thirty_two", legs: 32, factors: Some([4, 8]), turns: true },
    // Only for lines that one pass transforms whole, as twenty-four.
    Radix { name: "forty", legs: 40, factors: Some([8, 5]), turns: false },
    Radix { name: "sixty_four", legs: 64, factors: Some([8, 8]), turns: false },
];

/// The variants of the slot: path and text.
pub fn variants() -> impl Iterator<Item = (String, String)> {
    RADICES.iter().map(|radix| (format!("smoothing/radix/{}", radix.name), radix.text()))
}

impl Radix {
    fn text(&self) -> String {
        let Self { legs, .. } = *self;
        let mut text = format!("// Butterflies of {} legs.\n", self.name.replace('_', "-"));
        let _ = writeln!(text, "const RADIX = {legs}u;\nalias Legs = array<vec2<f32>, {legs}>;\n");
        text += &self.small_transforms();
        text += &self.roots();
        text += &self.transformed();
        text += &self.gathered_and_scattered();
        if self.turns {
            text += &self.turned();
        }
        if let Some(factors) = self.factors.filter(|_| legs.is_power_of_two()) {
            text += &self.shared(factors);
        }
        text += "// Multiplies every leg by the smoothing of its wave, real and imaginary part exchanged for the way back.\n";
        let weighed = (0..legs).map(|leg| format!("v[{leg}].yx * symbol(butterfly, {leg}u)"));
        let _ = write!(text, "fn weighed_legs(v: Legs, butterfly: Butterfly) -> Legs {{\n{}}}\n", returned(weighed));
        text
    }

    /// Transforms of two, three and five numbers, of which larger ones are made.
    fn small_transforms(&self) -> String {
        let mut text = String::new();
        for factor in self.factors.into_iter().flatten() {
            text += match factor {
                2 => {
                    "fn fourier2(a: vec2<f32>, b: vec2<f32>) -> array<vec2<f32>, 2> {\n    \
                     return array<vec2<f32>, 2>(a + b, a - b);\n}\n"
                }
                3 => {
                    "fn fourier3(a: vec2<f32>, b: vec2<f32>, c: vec2<f32>) -> array<vec2<f32>, 3> {\n    \
                     let sum = b + c;\n    \
                     let middle = a - 0.5 * sum;\n    \
                     let across = 0.86602540378443864676 * quarter(b - c);\n    \
                     return array<vec2<f32>, 3>(a + sum, middle + across, middle - across);\n}\n"
                }
                5 => {
                    "fn fourier5(a: vec2<f32>, b: vec2<f32>, c: vec2<f32>, d: vec2<f32>, e: vec2<f32>) -> array<vec2<f32>, 5> {\n    \
                     let outer = b + e;\n    \
                     let inner = c + d;\n    \
                     let first = a + 0.30901699437494742410 * outer - 0.80901699437494742410 * inner;\n    \
                     let second = a - 0.80901699437494742410 * outer + 0.30901699437494742410 * inner;\n    \
                     let p = quarter(b - e);\n    \
                     let q = quarter(c - d);\n    \
                     let first_across = 0.95105651629515357212 * p + 0.58778525229247312917 * q;\n    \
                     let second_across = 0.58778525229247312917 * p - 0.95105651629515357212 * q;\n    \
                     return array<vec2<f32>, 5>(\n        \
                     a + outer + inner,\n        first + first_across,\n        second + second_across,\n        \
                     second - second_across,\n        first - first_across,\n    );\n}\n"
                }
                _ => "",
            };
        }
        text
    }

    /// Powers of the root of unity that are no multiple of an eighth of a turn.
    fn roots(&self) -> String {
        let Some([first, second]) = self.factors else { return String::new() };
        let mut powers: Vec<usize> = (1..first).flat_map(|row| (1..second).map(move |column| row * column)).collect();
        powers.sort_unstable();
        powers.dedup();
        let mut text = format!("// Powers of exp(-2πi/{}).\n", self.legs);
        for power in powers.into_iter().filter(|power| self.eighths(*power).is_none() && !self.is_opposite(*power)) {
            let (sine, cosine) = (TAU * power as f64 / self.legs as f64).sin_cos();
            let _ = writeln!(text, "const ROOT{power} = vec2<f32>({cosine:.17}, {:.17});", -sine);
        }
        text + "\n"
    }

    /// Whether a power is taken for the opposite of the first: with sixteen legs, where it is the only one beyond half a turn.
    fn is_opposite(&self, power: usize) -> bool {
        self.legs == 16 && power == 9
    }

    /// The eighths of a turn that a power of the root of unity is, if it is a whole number.
    fn eighths(&self, power: usize) -> Option<usize> {
        (8 * power).is_multiple_of(self.legs).then_some(8 * power / self.legs)
    }

    /// A number multiplied by a power of the root of unity.
    fn turned_by(&self, power: usize, number: &str) -> String {
        match self.eighths(power) {
            Some(0) => number.to_owned(),
            Some(1) => format!("eighth({number})"),
            Some(2) => format!("quarter({number})"),
            Some(3) => format!("quarter(eighth({number}))"),
            Some(4) => format!("-{number}"),
            _ if self.is_opposite(power) => format!("-times({number}, ROOT1)"),
            _ => format!("times({number}, ROOT{power})"),
        }
    }

    fn transformed(&self) -> String {
        let legs = self.legs;
        let mut text = String::from(
            "// Leg by leg: naga takes an alias for a type of its own, and returning one for the other makes SPIR-V and HLSL that are\n\
             // not valid.\nfn transformed(v: Legs) -> Legs {\n",
        );
        let results: Vec<String> = match self.factors {
            None if legs == 2 => vec!["v[0] + v[1]".to_owned(), "v[0] - v[1]".to_owned()],
            None => {
                let all: Vec<String> = (0..legs).map(|leg| format!("v[{leg}]")).collect();
                let _ = writeln!(text, "    let t = fourier{legs}({});", all.join(", "));
                (0..legs).map(|leg| format!("t[{leg}]")).collect()
            }
            Some([first, second]) => {
                for column in 0..second {
                    let every: Vec<String> = (0..first).map(|row| format!("v[{}]", column + row * second)).collect();
                    let _ = writeln!(text, "    let s{column} = fourier{first}({});", every.join(", "));
                }
                for row in 0..first {
                    let turned: Vec<String> =
                        (0..second).map(|column| self.turned_by(row * column, &format!("s{column}[{row}]"))).collect();
                    let _ = writeln!(text, "    let t{row} = fourier{second}({});", turned.join(", "));
                }
                (0..legs).map(|leg| format!("t{}[{}]", leg % first, leg / first)).collect()
            }
        };
        text + &returned(results.into_iter()) + "}\n\n"
    }

    /// Legs half a radix apart lie next to each other in memory.
    fn gathered_and_scattered(&self) -> String {
        let half = self.legs / 2;
        let mut text = String::from("fn gathered(butterfly: Butterfly) -> Legs {\n");
        for pair in 0..half {
            let _ = writeln!(text, "    let p{pair} = load_pair(butterfly, {pair}u);");
        }
        let parts = ["xy", "zw"].into_iter().flat_map(|part| (0..half).map(move |pair| format!("p{pair}.{part}")));
        text = text + &returned(parts) + "}\nfn scattered(butterfly: Butterfly, v: Legs) {\n";
        for leg in 0..half {
            let _ = writeln!(text, "    store_pair(butterfly, {leg}u, vec4<f32>(v[{leg}], v[{}]));", leg + half);
        }
        text + "}\n\n"
    }

    fn turned(&self) -> String {
        let mut text = String::from(
            "// Multiplies leg j by the j-th power of a root of unity.\nfn turned_legs(v: Legs, step: u32) -> Legs {\n    let w1 = roots[step];\n",
        );
        for power in 2..self.legs {
            let largest = 1 << power.ilog2();
            let _ = if power == largest {
                writeln!(text, "    let w{power} = roots[{power}u * step];")
            } else {
                writeln!(text, "    let w{power} = times(w{largest}, w{});", power - largest)
            };
        }
        let turned =
            (0..self.legs).map(|leg| if leg == 0 { "v[0]".to_owned() } else { format!("times(v[{leg}], w{leg})") });
        text + &returned(turned) + "}\n\n"
    }

    /// The same transform by several lanes: each makes one of the first transforms and one of the second ones.
    fn shared(&self, [first, second]: [usize; 2]) -> String {
        let stride = second + 1;
        let shared = first * stride;
        let mut text = format!(
            "// The same by {second} lanes: lane j makes the first transform of the legs j, j + {second} and so on, and, of the first {first} lanes, the\n\
             // second transform of what all have in row j.\n\
             const FIRST = {first}u;\nconst SECOND = {second}u;\nconst SHARED = {shared}u;\n\
             // Of all butterflies of a workgroup.\nconst SHARED_LEGS = {}u;\n\
             alias FirstLegs = array<vec2<f32>, {first}>;\nalias SecondLegs = array<vec2<f32>, {second}>;\n\n",
            LANES / second * shared
        );
        text += &self.turned_by_any_power([first, second]);
        text += "fn first_gathered(butterfly: Butterfly, column: u32) -> FirstLegs {\n";
        for pair in 0..first / 2 {
            let _ = writeln!(text, "    let p{pair} = load_pair(butterfly, column + {}u);", pair * second);
        }
        let parts = ["xy", "zw"].into_iter().flat_map(|part| (0..first / 2).map(move |pair| format!("p{pair}.{part}")));
        text += &returned_as("FirstLegs", parts);
        text += "}\nfn first_transformed(v: FirstLegs, column: u32, place: u32) {\n";
        let all: Vec<String> = (0..first).map(|leg| format!("v[{leg}]")).collect();
        let _ = writeln!(text, "    let s = fourier{first}({});", all.join(", "));
        for row in 0..first {
            let turned =
                if row == 0 { "s[0]".to_owned() } else { format!("turned_by_power(s[{row}], {row}u * column)") };
            let _ = writeln!(text, "    shared_legs[place + {}u + column] = {turned};", row * stride);
        }
        let _ = writeln!(text, "}}\nfn second_transformed(row: u32, place: u32) -> SecondLegs {{");
        let _ = writeln!(text, "    let begin = place + row * {stride}u;");
        let all: Vec<String> = (0..second).map(|column| format!("shared_legs[begin + {column}u]")).collect();
        let _ = writeln!(text, "    let t = fourier{second}({});", all.join(", "));
        text += &returned_as("SecondLegs", (0..second).map(|leg| format!("t[{leg}]")));
        text += "}\nfn second_scattered(butterfly: Butterfly, row: u32, v: SecondLegs) {\n";
        for leg in 0..second / 2 {
            let (place, other) = (leg * first, leg + second / 2);
            let _ = writeln!(text, "    store_pair(butterfly, row + {place}u, vec4<f32>(v[{leg}], v[{other}]));");
        }
        text += "}\n// Weighs legs, see below, and shares them in their order.\n\
                 fn second_weighed(butterfly: Butterfly, row: u32, v: SecondLegs, place: u32) {\n";
        for leg in 0..second {
            let number = leg * first;
            let _ = writeln!(
                text,
                "    shared_legs[place + row + {number}u] = v[{leg}].yx * symbol(butterfly, row + {number}u);"
            );
        }
        text += "}\nfn first_shared(column: u32, place: u32) -> FirstLegs {\n";
        text +=
            &returned_as("FirstLegs", (0..first).map(|row| format!("shared_legs[place + column + {}u]", row * second)));
        text += "}\n";
        if self.turns {
            text += "// Multiplies legs by powers of a root of unity, as turned_legs does.\n\
                     fn first_turned(v: FirstLegs, column: u32, step: u32) -> FirstLegs {\n";
            text += &returned_as(
                "FirstLegs",
                (0..first).map(|row| format!("turned_leg(v[{row}], column + {}u, step)", row * second)),
            );
            text += "}\n";
        }
        text + "\n"
    }

    /// A number multiplied by a power that differs from lane to lane: by the same operations as where it is known.
    fn turned_by_any_power(&self, [first, second]: [usize; 2]) -> String {
        let most = (first - 1) * (second - 1);
        let roots = (0..=most).map(|power| {
            let named = self.eighths(power).is_none() && !self.is_opposite(power);
            let is_used = (1..first).any(|row| (1..second).any(|column| row * column == power));
            if named && is_used { format!("ROOT{power}") } else { "vec2<f32>(1.0, 0.0)".to_owned() }
        });
        let mut text = format!("const SHARED_ROOTS = array<vec2<f32>, {}>(\n", most + 1);
        for root in roots {
            let _ = writeln!(text, "    {root},");
        }
        text += ");\nfn turned_by_power(number: vec2<f32>, power: u32) -> vec2<f32> {\n";
        if self.legs == 16 {
            text += "    if (power == 9u) { return -times(number, ROOT1); }\n";
        }
        let eighth = self.legs / 8;
        let _ = write!(
            text,
            "    if (power % {eighth}u != 0u) {{ return times(number, SHARED_ROOTS[power]); }}\n    \
             let odd = select(number, eighth(number), ((power / {eighth}u) & 1u) == 1u);\n    \
             return select(odd, quarter(odd), ((power / {eighth}u) & 2u) == 2u);\n}}\n\n"
        );
        text
    }
}

/// A function's last statement: the legs, a line each.
fn returned(legs: impl Iterator<Item = String>) -> String {
    returned_as("Legs", legs)
}

fn returned_as(name: &str, legs: impl Iterator<Item = String>) -> String {
    let lines: Vec<String> = legs.map(|leg| format!("        {leg},")).collect();
    format!("    return {name}(\n{}\n    );\n", lines.join("\n"))
}
