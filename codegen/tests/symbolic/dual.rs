//! The functions of the language on dual numbers.

use bricard_codegen::internals::expr::Function;
use num_dual::DualNum;

/// The value, with as many derivatives as the number carries; at a kink those of one side.
pub fn function<D: DualNum<Primitive = f64> + Copy>(function: Function, x: D) -> D {
    match function {
        Function::Sin => x.sin(),
        Function::Cos => x.cos(),
        Function::Tan => x.tan(),
        Function::Asin => x.asin(),
        Function::Acos => x.acos(),
        Function::Atan => x.atan(),
        Function::Sinh => x.sinh(),
        Function::Cosh => x.cosh(),
        Function::Tanh => x.tanh(),
        Function::Exp => x.exp(),
        Function::Ln => x.ln(),
        Function::Sqrt => x.sqrt(),
        Function::Abs => x.abs(),
        Function::Sign => x.signum(),
        Function::Table(_) => unreachable!("no long table is among these"),
    }
}
