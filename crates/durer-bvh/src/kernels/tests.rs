use super::avx2::Numbers;
use super::{Avx2, Avx512, Kernel, Rows, Scalar, Stack, Together};
use crate::frame::Frame;
use crate::node::{ChildRef, Node, WIDTH};
use crate::ray::{ClippedRay, CullRay, PACKET, Packet32, Ray32, Ray64, Rounding, TWICE, TreeRay};
use crate::tree::Bvh;
use crate::triangles::{Block, Filter, LANES, Verdict};
use durer_math::eft::exponent;
use durer_math::{Aabb, Isa, Point3, Vec3};
use proptest::prelude::*;

/// On a coarse grid rays meet planes, edges and corners exactly; on a fine one they do not.
fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![
        (-4_i32..=4).prop_map(|i| i as f32 / 4.0),
        -1.0_f32..1.0,
        (-1.0_f32..1.0).prop_map(|x| x * 1e-30),
        Just(0.0),
    ]
}

fn node() -> impl Strategy<Value = Node> {
    let boxes = prop::collection::vec(
        (prop::array::uniform3(coordinate()), prop::array::uniform3(coordinate())),
        0..=WIDTH,
    );
    boxes.prop_map(|boxes| {
        let mut node = Node::EMPTY;
        for (i, (a, b)) in boxes.into_iter().enumerate() {
            let lo = [0, 1, 2].map(|k| a[k].min(b[k]));
            let hi = [0, 1, 2].map(|k| a[k].max(b[k]));
            node.set(i, lo, hi, ChildRef::node(i + 100));
        }
        node.sort();
        node
    })
}

fn direction() -> impl Strategy<Value = [f64; 3]> {
    let component =
        prop_oneof![Just(0.0), Just(-0.0), -2.0..2.0_f64, (-2.0..2.0_f64).prop_map(|x| x * 1e-300)];
    (prop::array::uniform3(component), 0..3_usize, 1.0..2.0_f64, any::<bool>()).prop_map(
        |(mut d, axis, x, minus)| {
            d[axis] = if minus { -x } else { x };
            d
        },
    )
}

/// A ray from `origin` with an unbounded range.
fn line(origin: [f64; 3], direction: [f64; 3]) -> Ray64 {
    Ray64 {
        origin: Point3::from(origin),
        direction: Vec3::from(direction),
        origin_error: Vec3::ZERO,
        direction_error: Vec3::ZERO,
        t_min: 0.0,
        t_max: f64::INFINITY,
        inner: (0.0, f64::INFINITY),
    }
}

/// Sixteen rays that are similar to one.
fn neighbours(o: [f64; 3], d: [f64; 3], aside: &[Moved], bent: &[Moved], t_max: &[f64]) -> Vec<Ray64> {
    let moved = |by: &Moved, i: usize| if by.1 { by.0[i] } else { 0.0 };
    (0..TWICE)
        .map(|i| {
            let origin = [0, 1, 2].map(|k| o[k] + moved(&aside[i], k));
            let d = [0, 1, 2].map(|k| d[k] + moved(&bent[i], k).copysign(d[k]));
            let d = Vec3::from(d);
            let d = d.scale2(-exponent(d.max_abs()));
            Ray64 { t_max: t_max[i], inner: (0.0, t_max[i]), ..line(origin, d.to_array()) }
        })
        .collect()
}

type Moved = ([f64; 3], bool);

fn moved() -> impl Strategy<Value = Vec<Moved>> {
    prop::collection::vec((prop::array::uniform3(0.0..0.06_f64), any::<bool>()), TWICE)
}

fn ends() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(prop_oneof![Just(f64::INFINITY), 0.0..4.0_f64], TWICE)
}

/// The first of these rays as a packet, if they can form one.
fn as_packet<K: Together<N>, const N: usize>(kernel: K, tree: &Bvh, lines: &[Ray64]) -> Option<K::Packet> {
    let eight = |lines: &[Ray64]| {
        let glances: [Ray32; PACKET] = core::array::from_fn(|i| lines[i].glance());
        Packet32::of(&glances)
    };
    let glances: Option<Vec<Packet32>> = lines[..N].chunks(PACKET).map(eight).collect();
    let glances = glances?;
    kernel.gather(tree, &glances.iter().collect::<Vec<_>>())
}

/// Checks that a kernel pushes what the scalar one does.
fn stacks_alike(
    kernel: impl Kernel<Ray = Numbers>,
    node: &Node,
    ray: &CullRay,
    t_far: f32,
) -> Result<(), TestCaseError> {
    let lanes = &kernel.spread(&Numbers::of(ray));
    let (mut a, mut b) = (Stack::new(), Stack::new());
    let scalar = Scalar::<true>.descend::<true>(node, ray, t_far, &mut a);
    prop_assert_eq!(scalar, kernel.descend::<true>(node, lanes, t_far, &mut b));
    prop_assert_eq!(a.drain(), b.drain());
    a.clear();
    b.clear();
    let scalar = Scalar::<true>.descend::<false>(node, ray, t_far, &mut a);
    prop_assert_eq!(scalar, kernel.descend::<false>(node, lanes, t_far, &mut b));
    prop_assert_eq!(a.drain(), b.drain());
    for slot in 0..WIDTH {
        prop_assert_eq!(Scalar::<true>.meets(node, slot, ray, t_far), kernel.meets(node, slot, lanes, t_far));
    }
    Ok(())
}

/// Checks that verdicts are equal, with equal bounds for lanes alive.
fn same_verdict(a: &Verdict, b: &Verdict) -> Result<(), TestCaseError> {
    prop_assert_eq!((a.alive, a.sure), (b.alive, b.sure));
    for lane in (0..LANES).filter(|lane| a.alive >> lane & 1 != 0) {
        prop_assert_eq!(a.lo[lane].to_bits(), b.lo[lane].to_bits());
        prop_assert_eq!(a.hi[lane].to_bits(), b.hi[lane].to_bits());
    }
    Ok(())
}

/// Checks that a packet pushes for each of its rays what the single ray pushes.
fn enters_alike<K: Together<N> + Kernel<Ray = Numbers>, const N: usize>(
    kernel: K,
    node: Node,
    lines: &[Ray64],
) -> Result<(), TestCaseError> {
    let mut tree = Bvh::assembled(Frame::around(&Aabb::EMPTY), vec![0, 1]);
    tree.set_nodes(vec![node]);
    let Some(packet) = as_packet::<K, N>(kernel, &tree, lines) else { return Ok(()) };
    let ends = kernel.ends(&packet);
    let far = ends.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let mut rows = Rows::new();
    kernel.descend_together::<true>(&node, &packet, &[f32::NEG_INFINITY; N], (&ends, far), &mut rows);
    let rows = rows.drain();
    for (i, line) in lines[..N].iter().enumerate() {
        let Some((ray, way)) = kernel.set_up(&tree, line) else {
            return Err(TestCaseError::fail("it is nearby"));
        };
        let lanes = kernel.spread(&ray);
        let mut stack = Stack::new();
        let last = kernel.descend::<true>(&node, &lanes, way.t_far, &mut stack);
        let mut alone: Vec<u32> = stack.drain().into_iter().map(|(child, _)| child).collect();
        alone.push(last.0);
        alone.reverse();
        let mut among: Vec<u32> =
            rows.iter().filter(|(_, near)| !near[i].is_nan()).map(|&(child, _)| child).collect();
        among.push(ChildRef::END.0);
        prop_assert_eq!(&alone, &among);
        let (again, same) = kernel.one(&tree, &packet, i);
        let mut stack = Stack::new();
        kernel.descend::<true>(&node, &kernel.spread(&again), same.t_far, &mut stack);
        let mut waiting: Vec<(u32, u32)> = rows
            .iter()
            .filter(|(_, near)| !near[i].is_nan())
            .map(|&(child, near)| (child, near[i].to_bits()))
            .collect();
        waiting.reverse();
        waiting.pop();
        let mut stacked = stack.drain();
        stacked.retain(|&(child, _)| child != ChildRef::END.0);
        prop_assert_eq!(stacked, waiting);
    }
    Ok(())
}

/// Checks that a packet's verdicts are the scalar kernel's, for each ray that is awake.
fn judges_alike<K: Together<N>, const N: usize>(
    kernel: K,
    block: &Block,
    lines: &[Ray64],
    awake: u32,
    far: f32,
    rounded: bool,
) -> Result<(), TestCaseError> {
    let mut tree = Bvh::assembled(Frame::around(&Aabb::EMPTY), vec![0, 1]);
    let mut node = Node::EMPTY;
    node.set(0, [-1.0; 3], [1.0; 3], ChildRef::node(1));
    tree.set_nodes(vec![node]);
    tree.rounded = rounded;
    let Some(packet) = as_packet::<K, N>(kernel, &tree, lines) else { return Ok(()) };
    let t_far = kernel.ends(&packet).map(|end| end.min(far));
    let filters = kernel.filters(&tree, &packet);
    let awake = awake & ((1 << N) - 1);
    let mut verdicts = [Verdict::NOTHING; N];
    let alive = kernel.judge_together(block, &filters, awake, &t_far, &mut verdicts);
    for ray in 0..N {
        let filter = Filter::of_exact(&kernel.way(&tree, &packet, ray), rounded);
        let alone = Scalar::<true>.judge(block, &filter, t_far[ray]);
        let is_alive = awake >> ray & 1 != 0 && alone.alive != 0;
        prop_assert_eq!(alive >> ray & 1 != 0, is_alive);
        if is_alive {
            same_verdict(&alone, &verdicts[ray])?;
        }
    }
    Ok(())
}

/// Some triangles as a block.
fn block(corners: &[[[f32; 3]; 3]]) -> Block {
    let triangle = |v: &[[f32; 3]; 3]| v.map(|p| Point3::from(p.map(f64::from)));
    Block::new(Frame::around(&Aabb::EMPTY), (0..).zip(corners.iter().map(triangle))).0
}

fn corners() -> impl Strategy<Value = Vec<[[f32; 3]; 3]>> {
    prop::collection::vec(prop::array::uniform3(prop::array::uniform3(coordinate())), 1..=LANES)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn all_kernels_stack_the_same_bits(
        node in node(), o in prop::array::uniform3(coordinate()), far in 0..4_i32, d in direction(), t_far in 0.0..3.0_f32,
        t_near in prop_oneof![Just(0.0_f32), -3.0..3.0_f32, Just(f32::NEG_INFINITY)],
    ) {
        let Some(avx2) = Isa::available().find_map(Avx2::of) else { return Ok(()) };
        let o = o.map(|x| f64::from(x) * [1.0, 2.0, 1e3, 1e12][far as usize]);
        let line = line(o, d);
        let frame = Frame::around(&Aabb::EMPTY);
        let Some(ray) = CullRay::new(&line, frame.units(), &[-1.0; 3], &[1.0; 3], Rounding::Fused) else { return Ok(()) };
        let ray = CullRay { way: ClippedRay { t_near, ..ray.way }, ..ray };
        let t_far = t_far.min(ray.way.t_far);
        stacks_alike(avx2, &node, &ray, t_far)?;
        if let Some(avx512) = Isa::available().find_map(Avx512::of) {
            stacks_alike(avx512, &node, &ray, t_far)?;
        }
    }

    #[test]
    fn all_kernels_judge_triangles_alike(
        corners in corners(), o in prop::array::uniform3(coordinate()), d in direction(), far in 0.0..3.0_f32, rounded in any::<bool>(),
        t_near in prop_oneof![Just(0.0_f32), -3.0..3.0_f32], is_exact in any::<bool>(),
    ) {
        let Some(avx2) = Isa::available().find_map(Avx2::of) else { return Ok(()) };
        let block = block(&corners);
        let line = line(o.map(f64::from), d);
        let frame = Frame::around(&Aabb::EMPTY);
        let Some(ray) = CullRay::new(&line, frame.units(), &[-1.0; 3], &[1.0; 3], Rounding::Fused) else { return Ok(()) };
        let way = ClippedRay { t_near, is_exact, ..ray.way };
        let filter = Filter::new(|| line, &way, rounded);
        let one = Scalar::<true>.judge(&block, &filter, far);
        same_verdict(&one, &avx2.judge(&block, &filter, far))?;
        if let Some(avx512) = Isa::available().find_map(Avx512::of) {
            same_verdict(&one, &avx512.judge(&block, &filter, far))?;
        }
    }

    #[test]
    fn rays_that_go_together_enter_what_each_enters_alone(
        node in node(), o in prop::array::uniform3(coordinate()), far in 0..3_i32, d in direction(),
        aside in moved(), bent in moved(), t_max in ends(),
    ) {
        let o = o.map(|x| f64::from(x) * [1.0, 2.0, 3.5][far as usize]);
        let lines = neighbours(o, d, &aside, &bent, &t_max);
        if let Some(avx2) = Isa::available().find_map(Avx2::of) {
            enters_alike::<_, PACKET>(avx2, node, &lines)?;
        }
        if let Some(avx512) = Isa::available().find_map(Avx512::of) {
            enters_alike::<_, PACKET>(avx512, node, &lines)?;
            enters_alike::<_, TWICE>(avx512, node, &lines)?;
        }
    }

    #[test]
    fn rays_that_go_together_judge_triangles_as_each_does_alone(
        corners in corners(), o in prop::array::uniform3(coordinate()), far in 0..3_i32, d in direction(),
        aside in moved(), bent in moved(), t_max in ends(), awake in 0..65536_u32, limit in 0.0..4.0_f32, rounded in any::<bool>(),
    ) {
        let block = block(&corners);
        let o = o.map(|x| f64::from(x) * [1.0, 2.0, 3.5][far as usize]);
        let lines = neighbours(o, d, &aside, &bent, &t_max);
        if let Some(avx2) = Isa::available().find_map(Avx2::of) {
            judges_alike::<_, PACKET>(avx2, &block, &lines, awake, limit, rounded)?;
        }
        if let Some(avx512) = Isa::available().find_map(Avx512::of) {
            judges_alike::<_, PACKET>(avx512, &block, &lines, awake, limit, rounded)?;
            judges_alike::<_, TWICE>(avx512, &block, &lines, awake, limit, rounded)?;
        }
    }
}
