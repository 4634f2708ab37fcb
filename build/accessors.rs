//! WGSL made from the table of arrays: declarations, and the functions by which kernels come to an array in a buffer or in
//! textures, one file for each place.

use std::fmt::Write as _;

use crate::arrays::{ACCESSES, ARRAYS, Access, Array, Element, Function, Packed, Place, Seen};

/// The page that declares arrays as most kernels see them.
pub const DECLARED: &str = "arrays/declared";

/// The pages and variants that the table makes, by their paths.
pub fn files() -> Vec<(String, String)> {
    let variants = ACCESSES.iter().flat_map(|access| {
        let of_place = |(variant, place): &(&str, Place)| (format!("{}/{variant}", access.slot), text(access, place));
        access.places.iter().map(of_place)
    });
    variants.chain([(DECLARED.to_owned(), declarations())]).collect()
}

/// Variables of the arrays that kernels see as such.
fn declarations() -> String {
    let mut text = "// Arrays, and what they are for.\n\n".to_owned();
    for Array { name, seen, purpose } in ARRAYS {
        let _ = match seen {
            Seen::As(of) => writeln!(text, "var<storage, read_write> {name}: {of}; // {purpose}"),
            Seen::ReadAs(of) => writeln!(text, "var<storage, read> {name}: {of}; // {purpose}"),
            Seen::ByFunctions | Seen::InPlaceOf(_) => continue,
        };
    }
    text
}

fn text(access: &Access, place: &Place) -> String {
    let purpose = ARRAYS.iter().find(|array| array.name == access.array).map_or("", |array| array.purpose);
    let purpose = purpose[..1].to_uppercase() + &purpose[1..];
    let mut text = match place {
        Place::Buffer | Place::ReadBuffer => format!("// {purpose}, in a buffer.\n"),
        Place::Texture => format!("// {purpose}, in a texture.\n"),
        Place::Textures(_) => format!("// {purpose}, in textures.\n"),
    };
    let copied = access.functions.iter().flat_map(|function| match function {
        Function::Copy(_, arrays) => *arrays,
        _ => &[],
    });
    match place {
        Place::Buffer | Place::ReadBuffer => {
            let access_mode = if matches!(place, Place::ReadBuffer) { "read" } else { "read_write" };
            for name in copied.take(1).chain([&access.array]) {
                let _ = writeln!(text, "var<storage, {access_mode}> {name}: array<{}>;", stored(&access.element));
            }
        }
        Place::Texture => {
            let format = format(texels(&access.element)[0]);
            let _ = writeln!(text, "var {}: texture_storage_2d<{format}, read_write>;", access.array);
        }
        Place::Textures(names) => {
            let texels = texels(&access.element);
            for (name, texel) in copied.zip(&texels).chain(names.iter().zip(&texels)) {
                let _ = writeln!(text, "var {name}: texture_storage_2d<{}, read_write>;", format(texel));
            }
        }
    }
    text.push('\n');
    for (number, function) in access.functions.iter().enumerate() {
        let at = At { access, place, before: &access.functions[..number] };
        text.push_str(&match function {
            Function::Load(name) => at.load(name),
            Function::Store(name) => at.store(name),
            Function::LoadField(name, field) => at.load_field(name, field),
            Function::StoreField(name, field) => at.store_field(name, field),
            Function::Copy(name, from) => at.copy(name, from),
        });
    }
    text
}

/// What a buffer holds.
fn stored(element: &Element) -> &'static str {
    match element {
        Element::Number(of) | Element::Fields(of, _) => of,
        Element::Packed(packed) => packed.stored,
    }
}

/// Names of the fields of an element.
pub fn fields(element: &Element) -> Vec<&'static str> {
    match element {
        Element::Number(_) => Vec::new(),
        Element::Fields(_, fields) => fields.iter().map(|(name, _)| *name).collect(),
        Element::Packed(packed) => packed.texels.iter().flat_map(|(_, fields)| *fields).copied().collect(),
    }
}

/// Types of the texels of an element.
fn texels(element: &Element) -> Vec<&'static str> {
    match element {
        Element::Number(of) => vec![of],
        Element::Fields(_, fields) => fields.iter().map(|(_, of)| *of).collect(),
        Element::Packed(packed) => {
            packed.texels.iter().map(|(_, fields)| if fields.len() == 1 { "vec2<u32>" } else { "vec4<u32>" }).collect()
        }
    }
}

/// The format of texels of a type.
fn format(of: &str) -> &'static str {
    match of {
        "u32" => "r32uint",
        "vec2<u32>" | "vec2<f32>" => "rg32uint",
        _ => "rgba32uint",
    }
}

/// The value of a type in a loaded texel.
fn from_texel(of: &str, texel: &str) -> String {
    match of {
        "u32" => format!("{texel}.x"),
        "vec2<u32>" => format!("{texel}.xy"),
        "vec2<f32>" => format!("bitcast<vec2<f32>>({texel}.xy)"),
        "vec4<u32>" => texel.to_owned(),
        _ => format!("bitcast<{of}>({texel})"),
    }
}

/// The texel of a value of a type.
fn to_texel(of: &str, value: &str) -> String {
    match of {
        "u32" => format!("vec4<u32>({value})"),
        "vec2<u32>" => format!("vec4<u32>({value}, 0u, 0u)"),
        "vec2<f32>" => format!("vec4<u32>(bitcast<vec2<u32>>({value}), 0u, 0u)"),
        "vec4<u32>" => value.to_owned(),
        _ => format!("bitcast<vec4<u32>>({value})"),
    }
}

/// A function for an array at a place, after those before it.
struct At<'a> {
    access: &'a Access,
    place: &'a Place,
    before: &'a [Function],
}

impl At<'_> {
    fn in_buffer(&self) -> bool {
        matches!(self.place, Place::Buffer | Place::ReadBuffer)
    }

    /// The texture of a texel of an element, and where it is there.
    fn texel(&self, texel: usize) -> String {
        let name = self.access.array;
        match (self.place, texels(&self.access.element).len(), texel) {
            (Place::Textures(names), _, _) => format!("{}, texel(index)", names[texel]),
            (_, 1, _) => format!("{name}, texel(index)"),
            (_, count, 0) => format!("{name}, texel({count}u * index)"),
            (_, count, _) => format!("{name}, texel({count}u * index + {texel}u)"),
        }
    }

    fn load(&self, function: &str) -> String {
        let name = self.access.array;
        let (of, value) = match &self.access.element {
            Element::Packed(packed) => {
                let texel =
                    |(number, of): (usize, &&str)| from_texel(of, &format!("textureLoad({})", self.texel(number)));
                let value = if self.in_buffer() {
                    format!("{}({name}[index])", packed.unpack)
                } else {
                    let texels: Vec<String> = texels(&self.access.element).iter().enumerate().map(texel).collect();
                    format!("{}({})", packed.unpack_texels, texels.join(", "))
                };
                (packed.known, value)
            }
            Element::Number(of) | Element::Fields(of, _) if self.in_buffer() => (*of, format!("{name}[index]")),
            Element::Number(of) => (*of, from_texel(of, &format!("textureLoad({})", self.texel(0)))),
            Element::Fields(of, fields) => {
                let value = |(number, (field, of)): (usize, &(&str, &str))| {
                    let known = self.before.iter().find_map(|known| match known {
                        Function::LoadField(function, known) if known == field => Some(format!("{function}(index)")),
                        _ => None,
                    });
                    known.unwrap_or_else(|| from_texel(of, &format!("textureLoad({})", self.texel(number))))
                };
                let values: Vec<String> = fields.iter().enumerate().map(value).collect();
                (*of, format!("{of}({})", values.join(", ")))
            }
        };
        written(&format!("fn {function}(index: u32) -> {of}"), &[format!("return {value};")])
    }

    fn store(&self, function: &str) -> String {
        let name = self.access.array;
        // A function before this one that stores a field.
        let known = |fields: &[&str], value: &str| {
            self.before.iter().find_map(|known| match known {
                Function::StoreField(function, field) if fields.contains(field) => {
                    Some(format!("{function}(index, {value});"))
                }
                _ => None,
            })
        };
        let store = |number: usize, word: &str| format!("textureStore({}, {word});", self.texel(number));
        let (of, body) = match &self.access.element {
            Element::Number(of) | Element::Fields(of, _) if self.in_buffer() => {
                (*of, vec![format!("{name}[index] = value;")])
            }
            Element::Number(of) => (*of, vec![store(0, &to_texel(of, "value"))]),
            Element::Fields(of, fields) => {
                let line = |(number, (field, of)): (usize, &(&str, &str))| {
                    let value = format!("value.{field}");
                    known(&[*field], &value).unwrap_or_else(|| store(number, &to_texel(of, &value)))
                };
                (*of, fields.iter().enumerate().map(line).collect())
            }
            Element::Packed(packed) if self.in_buffer() => {
                (packed.known, vec![format!("{name}[index] = {}(value);", packed.pack)])
            }
            Element::Packed(packed) => {
                let line = |(number, (word, fields)): (usize, &(&str, &[&str]))| {
                    known(fields, "value").unwrap_or_else(|| store(number, &format!("{word}(value)")))
                };
                (packed.known, packed.texels.iter().enumerate().map(line).collect())
            }
        };
        written(&format!("fn {function}(index: u32, value: {of})"), &body)
    }

    fn load_field(&self, function: &str, field: &str) -> String {
        let name = self.access.array;
        let (of, value) = match &self.access.element {
            Element::Number(_) => ("u32", String::new()),
            Element::Fields(_, fields) => {
                let (number, of) = numbered(fields, field);
                let texel = || from_texel(of, &format!("textureLoad({})", self.texel(number)));
                (of, if self.in_buffer() { format!("{name}[index].{field}") } else { texel() })
            }
            Element::Packed(packed) => {
                let (number, part) = place_in_texels(packed, field);
                let texel = || format!("textureLoad({}).{}", self.texel(number), ["xy", "zw"][part]);
                ("vec2<u32>", if self.in_buffer() { format!("two_words({name}[index].{field})") } else { texel() })
            }
        };
        written(&format!("fn {function}(index: u32) -> {of}"), &[format!("return {value};")])
    }

    fn store_field(&self, function: &str, field: &str) -> String {
        let name = self.access.array;
        let (of, body) = match &self.access.element {
            Element::Number(_) => ("u32", Vec::new()),
            Element::Fields(_, fields) => {
                let (number, of) = numbered(fields, field);
                let texel = || format!("textureStore({}, {});", self.texel(number), to_texel(of, "value"));
                (of, vec![if self.in_buffer() { format!("{name}[index].{field} = value;") } else { texel() }])
            }
            Element::Packed(packed) => {
                let (number, _) = place_in_texels(packed, field);
                let (word, fields) = packed.texels[number];
                let packing = format!("let stored = {}(value);", packed.pack);
                let fields = fields.iter().map(|field| format!("{name}[index].{field} = stored.{field};"));
                let in_buffer = || std::iter::once(packing).chain(fields).collect();
                let texel = || vec![format!("textureStore({}, {word}(value));", self.texel(number))];
                (packed.known, if self.in_buffer() { in_buffer() } else { texel() })
            }
        };
        written(&format!("fn {function}(index: u32, value: {of})"), &body)
    }

    fn copy(&self, function: &str, from: &[&str]) -> String {
        let name = self.access.array;
        let body: Vec<String> = match self.place {
            Place::Textures(names) => {
                let line = |(name, from): (&&str, &&str)| {
                    format!("textureStore({name}, texel(to_place), textureLoad({from}, texel(from_place)));")
                };
                names.iter().zip(from).map(line).collect()
            }
            _ => vec![format!("{name}[to_place] = {}[from_place];", from[0])],
        };
        written(&format!("fn {function}(from_place: u32, to_place: u32)"), &body)
    }
}

/// A function of these statements, on one line where they fit.
fn written(head: &str, statements: &[String]) -> String {
    match statements {
        [statement] if head.len() + statement.len() <= 105 => format!("{head} {{ {statement} }}\n"),
        _ => format!("{head} {{\n    {}\n}}\n", statements.join("\n    ")),
    }
}

/// Number and type of a field, which `check` has found to be one.
fn numbered<'a>(fields: &[(&str, &'a str)], field: &str) -> (usize, &'a str) {
    let place = fields.iter().position(|(known, _)| *known == field).unwrap_or(fields.len());
    (place, fields.get(place).map_or("u32", |(_, of)| of))
}

/// The texel that holds a field, and its half.
fn place_in_texels(packed: &Packed, field: &str) -> (usize, usize) {
    let mut places = packed
        .texels
        .iter()
        .enumerate()
        .filter_map(|(number, (_, fields))| Some((number, fields.iter().position(|known| *known == field)?)));
    places.next().unwrap_or_default()
}
