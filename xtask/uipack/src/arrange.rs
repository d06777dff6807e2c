//! The functions of a module in an order in which those that are alike stand beside each other: Brotli then says less about each.
//!
//! A compiler makes a function anew for each type that it serves, and the linker strews them over the module. What they do and
//! how they call each other stays the same; only their numbers change.

use std::convert::Infallible;
use std::ops::Range;

use anyhow::{Context, Result, anyhow};
use wasm_encoder::reencode::{Error, Reencode, utils};
use wasm_encoder::{CodeSection, FunctionSection, Module};
use wasmparser::{
    CodeSectionReader, CustomSectionReader, FunctionBody, FunctionSectionReader, Parser, Payload, TypeRef,
};

/// Bytes that are compared at a time: a short instruction or two.
const SHINGLE_BYTES: usize = 4;
/// Numbers by which two functions are compared. More of them find no better order.
const MARKS: usize = 32;

/// What a function is compared by: of all its shingles the lowest hash, in so many ways to hash. Two functions have as large a part
/// of them in common as of their shingles (MinHash, Broder 1997).
type Signature = [u32; MARKS];

/// The same module with its own functions in another order, and with nothing but what a browser runs.
pub(crate) fn alike_together(module: &[u8]) -> Result<Vec<u8>> {
    let read = read(module).context("the module cannot be read")?;
    let bodies: Vec<&[u8]> = read.bodies.iter().map(|body| &module[body.clone()]).collect();
    let order = chain(&bodies);
    let mut places = vec![0; order.len()];
    for (place, old) in (0..).zip(&order) {
        places[*old] = place;
    }
    let mut arranged = Module::new();
    let mut moved = Moved {
        imported: read.imported,
        order,
        places,
    };
    moved
        .parse_core_module(&mut arranged, Parser::new(0), module)
        .map_err(|error| anyhow!("the functions cannot be arranged: {error}"))?;
    Ok(arranged.finish())
}

/// What must be known of a module before it is written anew.
#[derive(Debug, Default)]
struct Read {
    /// Functions that come from outside. They have the first numbers.
    imported: u32,
    /// Where each function of its own stands.
    bodies: Vec<Range<usize>>,
}

fn read(module: &[u8]) -> Result<Read> {
    let mut read = Read::default();
    for payload in Parser::new(0).parse_all(module) {
        match payload? {
            Payload::ImportSection(section) => {
                for import in section.into_imports() {
                    read.imported += u32::from(matches!(import?.ty, TypeRef::Func(_)));
                }
            }
            Payload::CodeSectionEntry(body) => read.bodies.push(body.range()),
            _ => {}
        }
    }
    Ok(read)
}

/// An order that begins with the longest function and goes on with that of the rest which is most like the last.
fn chain(bodies: &[&[u8]]) -> Vec<usize> {
    let mut rest: Vec<(usize, Signature)> = bodies.iter().map(|body| signature(body)).enumerate().collect();
    let mut order = Vec::with_capacity(bodies.len());
    let mut next = (0..rest.len()).max_by_key(|at| bodies[rest[*at].0].len());
    while let Some(at) = next {
        let (last, marks) = rest.swap_remove(at);
        order.push(last);
        let likeness = |(index, other): &(usize, Signature)| {
            let common = marks.iter().zip(other).filter(|(one, two)| one == two).count();
            // Of those as much alike, the one that is as long; then the first, so that the order is the same each time.
            (
                common,
                -bodies[*index].len().abs_diff(bodies[last].len()).cast_signed(),
                -index.cast_signed(),
            )
        };
        next = (0..rest.len()).max_by_key(|at| likeness(&rest[*at]));
    }
    order
}

fn signature(body: &[u8]) -> Signature {
    let mut marks = [u32::MAX; MARKS];
    for shingle in body.windows(SHINGLE_BYTES) {
        let value = shingle
            .iter()
            .fold(0, |value, byte| value << 8 | u64::from(*byte));
        for (mark, way) in marks.iter_mut().zip(1..) {
            *mark = (*mark).min(hash(value, way));
        }
    }
    marks
}

/// The upper half of a mixed product (the multiplier is that of SplitMix64).
fn hash(value: u64, way: u64) -> u32 {
    let mixed = (value ^ way << 32).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let mixed = (mixed ^ mixed >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    u32::try_from(mixed >> 32).expect("half of 64 bits")
}

/// Writes a module anew with its functions in another order.
#[derive(Debug)]
struct Moved {
    imported: u32,
    /// Functions by their old places, in the new order.
    order: Vec<usize>,
    /// New places by the old ones.
    places: Vec<u32>,
}

impl Reencode for Moved {
    type Error = Infallible;

    fn function_index(&mut self, function: u32) -> Result<u32, Error> {
        let own = function.checked_sub(self.imported);
        let place = own.and_then(|own| self.places.get(usize::try_from(own).ok()?));
        Ok(place.map_or(function, |place| self.imported + place))
    }

    /// Names of functions and where each number stands are for linkers and debuggers: half of a module that a linker wrote.
    fn parse_custom_section(
        &mut self,
        _module: &mut Module,
        _section: CustomSectionReader<'_>,
    ) -> Result<(), Error> {
        Ok(())
    }

    fn parse_function_section(
        &mut self,
        functions: &mut FunctionSection,
        section: FunctionSectionReader<'_>,
    ) -> Result<(), Error> {
        let types = section.into_iter().collect::<Result<Vec<u32>, _>>()?;
        for old in &self.order {
            functions.function(types[*old]);
        }
        Ok(())
    }

    fn parse_code_section(
        &mut self,
        code: &mut CodeSection,
        section: CodeSectionReader<'_>,
    ) -> Result<(), Error> {
        let bodies = section
            .into_iter()
            .collect::<Result<Vec<FunctionBody<'_>>, _>>()?;
        for old in self.order.clone() {
            utils::parse_function_body(self, code, bodies[old].clone())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::{alike_together, chain};
    use wasm_encoder::{
        CodeSection, ExportKind, ExportSection, Function, FunctionSection, ImportSection, Instruction,
        Module, TypeSection, ValType,
    };
    use wasmparser::{ExternalKind, Operator, Parser, Payload};

    #[test]
    fn functions_that_are_alike_become_neighbours() {
        let bodies: Vec<Vec<u8>> = (0_u8..8)
            .map(|which| {
                (0..100)
                    .map(|at| if which % 2 == 0 { at } else { 255 - at / 2 })
                    .chain([which])
                    .collect()
            })
            .collect();
        let bodies: Vec<&[u8]> = bodies.iter().map(Vec::as_slice).collect();
        let odd: Vec<usize> = chain(&bodies).iter().map(|index| index % 2).collect();
        assert!(
            odd == [0, 0, 0, 0, 1, 1, 1, 1] || odd == [1, 1, 1, 1, 0, 0, 0, 0],
            "{odd:?}"
        );
    }

    /// An import, and functions that give 1, 2 and what the first of them gives.
    fn module() -> Vec<u8> {
        let mut types = TypeSection::new();
        types.ty().function([], [ValType::I32]);
        let mut imports = ImportSection::new();
        imports.import("outside", "it", wasm_encoder::EntityType::Function(0));
        let mut functions = FunctionSection::new();
        let mut code = CodeSection::new();
        let called = [
            Instruction::I32Const(1),
            Instruction::I32Const(2),
            Instruction::Call(1),
        ];
        for (index, instruction) in called.into_iter().enumerate() {
            functions.function(0);
            let mut function = Function::new([]);
            for _ in 0..index * 10 {
                function.instruction(&Instruction::Nop);
            }
            function.instruction(&instruction).instruction(&Instruction::End);
            code.function(&function);
        }
        let mut exports = ExportSection::new();
        exports.export("one", ExportKind::Func, 1);
        exports.export("calls", ExportKind::Func, 3);
        let mut module = Module::new();
        module
            .section(&types)
            .section(&imports)
            .section(&functions)
            .section(&exports)
            .section(&code);
        module.finish()
    }

    /// Numbers of the exported functions, and what each of its own does after its pauses.
    fn meaning(module: &[u8]) -> (Vec<u32>, Vec<String>) {
        let (mut exports, mut does) = (Vec::new(), Vec::new());
        for payload in Parser::new(0).parse_all(module) {
            match payload.unwrap() {
                Payload::ExportSection(section) => {
                    for export in section {
                        let export = export.unwrap();
                        assert_eq!(export.kind, ExternalKind::Func);
                        exports.push(export.index);
                    }
                }
                Payload::CodeSectionEntry(body) => {
                    let operators = body.get_operators_reader().unwrap().into_iter();
                    let first = operators
                        .map(|operator| operator.unwrap())
                        .find(|operator| *operator != Operator::Nop);
                    does.push(format!("{:?}", first.unwrap()));
                }
                _ => {}
            }
        }
        (exports, does)
    }

    #[test]
    fn who_is_called_and_exported_stays_the_same_function() {
        let arranged = alike_together(&module()).unwrap();
        let (exports, does) = meaning(&arranged);
        // The longest comes first: that which calls.
        assert_eq!(exports[1], 1);
        let own = |index: u32| &does[usize::try_from(index - 1).unwrap()];
        assert_eq!(own(exports[0]), "I32Const { value: 1 }");
        assert_eq!(
            *own(exports[1]),
            format!("Call {{ function_index: {} }}", exports[0])
        );
        assert_ne!(exports[0], 1, "it was moved");
    }

    #[test]
    fn bytes_that_are_no_module_are_refused() {
        assert!(alike_together(b"\0asm\x01\0\0\0\x0a\xff").is_err());
    }
}
