//! What a formula can be: a scalar, a vector, a matrix, an array of these.

use super::unit::Unit;
use crate::diagnostic::Span;
use crate::expr::{ExprId, Number};
use std::rc::Rc;

/// A scalar expression and its unit.
#[derive(Clone, Copy, Debug)]
pub struct Scalar {
    /// The expression.
    pub id: ExprId,
    /// What is known of its unit.
    pub unit: Unit,
}

impl Scalar {
    /// An expression in a unit.
    pub fn new(id: ExprId, unit: Unit) -> Self {
        Self { id, unit }
    }
}

/// All values, if there are all. Each is looked for though another one is missing, so that all
/// mistakes are told at once.
pub fn all<T>(values: impl Iterator<Item = Option<T>>) -> Option<Vec<T>> {
    let values: Vec<Option<T>> = values.collect();
    values.into_iter().collect()
}

/// A matrix of two to four rows of two to four entries.
#[derive(Clone, Debug)]
pub struct Matrix {
    /// The entries, row by row.
    pub rows: Vec<Vec<Scalar>>,
    /// The angular velocity in the body frame, where the matrix is known to be a
    /// rotation: far shorter than what comes out of RᵀṘ. That of a rotation in the plane is
    /// about the third axis.
    pub spin: Option<[Scalar; 3]>,
}

impl Matrix {
    /// Whether it has as many rows as columns.
    pub fn is_square(&self) -> bool {
        self.rows.iter().all(|row| row.len() == self.rows.len())
    }
}

/// An array: `coord n[K]` or `let n[i in 0..K]`.
#[derive(Clone, Debug)]
pub struct Array {
    /// The index of the first element.
    pub first: i64,
    /// The elements known so far.
    pub items: Vec<Value>,
    /// The index behind the last element.
    pub end: i64,
}

/// What a formula means.
#[derive(Clone, Debug)]
pub enum Value {
    /// A scalar.
    Scalar(Scalar),
    /// A vector of two to four components.
    Vector(Vec<Scalar>),
    /// A matrix.
    Matrix(Matrix),
    /// An array.
    Array(Rc<Array>),
}

impl Value {
    /// Its shape in words.
    pub fn shape(&self) -> String {
        match self {
            Value::Scalar(_) => "a number".into(),
            Value::Vector(parts) => format!("a vector of {} components", parts.len()),
            Value::Matrix(m) => format!("a {} × {} matrix", m.rows.len(), m.rows[0].len()),
            Value::Array(array) => format!("an array of {}", array.end - array.first),
        }
    }

    /// Whether sums, equations and choices of the two make sense.
    pub fn same_shape(&self, other: &Value) -> bool {
        match (self, other) {
            (Value::Array(_), _) | (_, Value::Array(_)) => false,
            _ => self.shape() == other.shape(),
        }
    }

    /// The scalar, if it is one.
    pub fn as_scalar(&self) -> Option<Scalar> {
        match self {
            Value::Scalar(scalar) => Some(*scalar),
            _ => None,
        }
    }

    /// The components, if it is a vector.
    pub fn as_vector(&self) -> Option<&Vec<Scalar>> {
        match self {
            Value::Vector(parts) => Some(parts),
            _ => None,
        }
    }

    /// An array of numbers as the vector that it is too; other values stay, and so
    /// does an array whose last elements are not known yet.
    pub fn array_to_vector(self) -> Value {
        let Value::Array(array) = &self else {
            return self;
        };
        let known = array.items.iter().map(Value::as_scalar);
        let parts: Option<Vec<Scalar>> = known.collect();
        let whole = array.items.len() as i64 == array.end - array.first;
        parts.filter(|_| whole).map_or(self.clone(), Value::Vector)
    }

    /// [`Value::array_to_vector`] where the components are counted from 0 again, so
    /// that an array counted from elsewhere would change the meaning of its indices.
    pub fn operand(self) -> Value {
        match &self {
            Value::Array(array) if array.first != 0 => self,
            _ => self.array_to_vector(),
        }
    }

    /// Its scalars in order; those of a matrix row by row.
    pub fn scalars(&self) -> Vec<Scalar> {
        match self {
            Value::Scalar(scalar) => vec![*scalar],
            Value::Vector(parts) => parts.clone(),
            Value::Matrix(matrix) => matrix.rows.concat(),
            Value::Array(array) => array.items.iter().flat_map(Value::scalars).collect(),
        }
    }

    /// This value in another unit; a rotation stays one.
    pub fn with_unit(&self, unit: Unit) -> Value {
        let scalars = self.scalars().into_iter();
        let mut value = self.with_scalars(scalars.map(|s| Scalar { unit, ..s }).collect());
        if let (Value::Matrix(new), Value::Matrix(old)) = (&mut value, self) {
            new.spin = old.spin;
        }
        value
    }

    /// A value of the same shape with other scalars, given in order.
    pub fn with_scalars(&self, scalars: Vec<Scalar>) -> Value {
        let mut scalars = scalars.into_iter();
        self.refill(&mut scalars)
    }

    fn refill(&self, scalars: &mut impl Iterator<Item = Scalar>) -> Value {
        let mut take = |old: &Scalar| scalars.next().unwrap_or(*old);
        match self {
            Value::Scalar(old) => Value::Scalar(take(old)),
            Value::Vector(parts) => Value::Vector(parts.iter().map(take).collect()),
            Value::Matrix(matrix) => {
                let rows = matrix
                    .rows
                    .iter()
                    .map(|row| row.iter().map(&mut take).collect());
                Value::Matrix(Matrix {
                    rows: rows.collect(),
                    spin: None,
                })
            }
            Value::Array(array) => {
                let items = array
                    .items
                    .iter()
                    .map(|item| item.refill(scalars))
                    .collect();
                Value::Array(Rc::new(Array {
                    first: array.first,
                    items,
                    end: array.end,
                }))
            }
        }
    }

    /// The suffix of the name of each scalar: `.x` of a vector, `[0][1]` of a
    /// matrix, `[2]` of an array.
    pub fn suffixes(&self) -> Vec<String> {
        match self {
            Value::Scalar(_) => vec![String::new()],
            Value::Vector(parts) => match AXES.get(..parts.len()) {
                Some(axes) => axes.iter().map(|axis| format!(".{axis}")).collect(),
                None => (0..parts.len()).map(|i| format!("[{i}]")).collect(),
            },
            Value::Matrix(matrix) => {
                let row = |i: usize, n: usize| (0..n).map(move |j| format!("[{i}][{j}]"));
                let rows = matrix.rows.iter().enumerate();
                rows.flat_map(|(i, entries)| row(i, entries.len()))
                    .collect()
            }
            Value::Array(array) => {
                let named = |(i, item): (usize, &Value)| {
                    let index = array.first + i as i64;
                    let suffixes = item.suffixes().into_iter();
                    suffixes
                        .map(move |suffix| format!("[{index}]{suffix}"))
                        .collect::<Vec<_>>()
                };
                array.items.iter().enumerate().flat_map(named).collect()
            }
        }
    }
}

/// The names of the components of a vector.
pub const AXES: [&str; 3] = ["x", "y", "z"];

/// A number without unit.
#[derive(Clone, Copy, Debug)]
pub struct Bare {
    /// The number.
    pub number: Number,
    /// Where it stands.
    pub span: Span,
    /// The power of it that the formula contains.
    pub power: f64,
}

impl Bare {
    /// Numbers such as 9.81 are measured, 2 is rather counted.
    pub fn is_measured(&self) -> bool {
        self.number.as_integer().is_none()
    }

    pub fn raised(self, power: f64) -> Self {
        Self {
            power: self.power * power,
            ..self
        }
    }
}
