//! Scalars, vectors, matrices and arrays.

use super::{accept, assert_close, output, refuse_each, refuse_saying, value, with};

const Q: f64 = 0.51;
const W: f64 = 0.80;

#[test]
fn vectors_are_calculated_with_component_by_component() {
    assert_close(value("([q, w] + [1, 2] - [w, q]).x"), Q + 1.0 - W);
    assert_close(value("(2*[q, w, 1]/w).z"), 2.0 / W);
    assert_close(value("(-[q, w]).y"), -W);
    assert_close(value("[q, w, 3][2]"), 3.0);
}

#[test]
fn products_of_vectors_have_names() {
    assert_close(value("dot([q, w], [w, 2])"), Q * W + 2.0 * W);
    assert_close(value("norm2([q, w])"), Q * Q + W * W);
    assert_close(value("norm([q, w, 1])"), (Q * Q + W * W + 1.0).sqrt());
    assert_close(value("cross([q, w], [3, 4])"), 4.0 * Q - 3.0 * W);
    assert_close(value("cross([q, w, 1], [2, 3, 4]).x"), W * 4.0 - 3.0);
    assert_close(value("cross([q, w, 1], [2, 3, 4]).y"), 2.0 - Q * 4.0);
    assert_close(value("cross([q, w, 1], [2, 3, 4]).z"), Q * 3.0 - W * 2.0);
}

#[test]
fn matrices_multiply_rows_by_columns() {
    assert_close(value("([[q, w], [1, 2]]*[3, 4]).x"), 3.0 * Q + 4.0 * W);
    assert_close(
        value("([[q, w], [1, 2]]*[[1, 2], [3, 4]])[0][1]"),
        2.0 * Q + 4.0 * W,
    );
    assert_close(value("transpose([[q, w], [1, 2]])[1][0]"), W);
    assert_close(value("([[q, w, 1], [1, 2, 3]]*[1, 1, 1]).x"), Q + W + 1.0);
    assert_close(
        value("(2*[[q, w], [1, 2]] - [[1, 1], [1, 1]])[0][0]"),
        2.0 * Q - 1.0,
    );
}

#[test]
fn shapes_that_do_not_fit_are_refused() {
    let table = "
        let v = [q, w] + 1; ⇒ this is a number
        let v = [q, w] + [1, 2, 3]; ⇒ a vector of 3 components
        let v = [q, w]*[1, 2]; ⇒ write `dot(a, b)` or `cross(a, b)`
        let v = 1/[1, 2]; ⇒ only a number can divide
        let v = sin([q, w]); ⇒ the argument of `sin` has to be a number
        let v = [q]; ⇒ two to four components
        let v = [[q, 1], 2]; ⇒ rows of one length
        let v = [q, w].z; ⇒ has no `.z`
        let v = q.x; ⇒ a number has no components
        let v = [q, w]^2; ⇒ norm2(v)
        let v = [1, 2]*rotz(q); ⇒ write `transpose(R)*v`
        let v = rotz(q)*[1, 2]; ⇒ as many columns as what stands behind it has rows
        constraint [q, w] = [1, 2, 3]; ⇒ both sides are numbers
        let v = if q < 1 then [1, 2] else 3; ⇒ the other a number
    ";
    refuse_each(with, table);
}

#[test]
fn arrays_of_coordinates_are_named_by_their_indices() {
    let m = accept(
        "mechanism M { const K = 3; coord p; coord theta[K]: rad;
        kinetic der(p)^2 + 1*sum(i in 0..K, p*der(theta[i])^2); }",
    );
    let names: Vec<_> = m.coordinates.iter().map(|q| q.name.as_str()).collect();
    assert_eq!(names, ["p", "theta[0]", "theta[1]", "theta[2]"]);
    assert_eq!(m.coordinates[3].unit, "rad");
}

#[test]
fn the_elements_of_a_let_array_may_use_those_before_them() {
    let source =
        with("let s[i in 0..4] = if i == 0 then q else s[i-1] + w; output y = s[3]; output z = s;");
    let m = accept(&source);
    assert_close(output(&m, "y"), Q + 3.0 * W);
    assert_close(output(&m, "z[2]"), Q + 2.0 * W);
    refuse_saying(
        &with("let s[i in 0..4] = s[3-i];"),
        "may use those before it",
    );
    let shifted = with("let s[i in 2..4] = [i, q]; output y = s[3].x;");
    assert_close(output(&accept(&shifted), "y"), 3.0);
}

#[test]
fn indices_are_whole_numbers_in_range() {
    let table = "
        coord p[3]; let a = p[3]; ⇒ an array of 3 has the indices 0 to 2
        coord p[3]; let a = p[-1]; ⇒ index -1 is out of range
        coord p[3]; let a = p[1/2]; ⇒ this is 0.5
        coord p[3]; let a = p[q]; ⇒ known when the code is generated
        let p[i in 0..3] = [q, i]; let a = 2*p; ⇒ a whole array can't stand in a calculation
        let p[i in 1..3] = i*q; let a = 2*p; ⇒ a whole array can't stand in a calculation
        let p[i in 0..3] = norm2(p); ⇒ `norm2` takes a vector, this is an array of 3
        coord p[1]; let a = cross(p, p); ⇒ `cross` takes two
        coord p[0]; ⇒ an array can't have 0 coordinates
        coord p[100000]; ⇒ more than 10000 coordinates
        let a[i in 0..0] = 1; ⇒ has no elements
        let a = q[0]; ⇒ a number has no elements
    ";
    refuse_each(with, table);
}

#[test]
fn a_literal_zero_stands_for_a_zero_vector_in_an_equation() {
    let m = accept(&with("constraint [q, w] = 0;"));
    assert_eq!(m.constraints.len(), 2);
    refuse_saying(
        &with("constraint [q, w] = 1;"),
        "one side of this equation is",
    );
}

#[test]
fn an_empty_sum_is_zero() {
    assert_close(value("sum(i in 0..0, q) + sum(i in 3..1, [1, 2])"), 0.0);
}

#[test]
fn four_components_and_arrays_of_numbers_have_lengths_and_products() {
    let source = "coord e[4]; let v = [e[0], e[1], e[2], e[3]]; let E = [[-e[1], e[0], e[3], -e[2]], [1, 2, 3, 4]];
        output a = norm2(e) - norm2(v); output b = dot(e, v) - norm(e)^2; output c = (E*v).y; output d = v;
        constraint norm2(e) = 1;";
    let m = accept(&with(source));
    assert_close(output(&m, "a"), 0.0);
    assert_close(output(&m, "b"), 0.0);
    let e = |i: usize| 0.51 + 0.29 * (i as f64 + 2.0);
    assert_close(
        output(&m, "c"),
        (0..4).map(|i| (i as f64 + 1.0) * e(i)).sum(),
    );
    assert_close(output(&m, "d[3]"), e(3));
    let table = "
        let a = cross([q, w, 1, 2], [1, 2, 3, 4]); ⇒ two or three components
        let a = [1, 2, 3, 4, 5]; ⇒ here are 5
        draw trace([1, 2, 3, 4]); ⇒ a point is written
    ";
    refuse_each(with, table);
}
