//! Facts about expressions, each observed in POV-Ray 3.7.

mod support;

use support::{debug, fault, float, vector};

#[test]
fn operators_have_their_ranks() {
    assert_eq!(float("-2*-3+4/2", 2), "8.00");
    assert_eq!(float("3-2-1", 0), "0");
    assert_eq!(float("2/2/2", 1), "0.5");
    assert_eq!(float("1+-2", 0), "-1");
    assert_eq!(float("!1", 0), "0");
    assert_eq!(float("<1,2,3>.y*2", 0), "4");
    assert_eq!(vector(3, "-x*3+y-z"), "-3.0000,1.0000,-1.0000");
}

#[test]
fn comparisons_live_in_parentheses_and_have_one_rank() {
    assert_eq!(float("(1|0&0)", 0), "0");
    assert_eq!(float("(0&0|1)", 0), "1");
    assert_eq!(float("(1=1=1)", 0), "1");
    assert_eq!(float("(2<3&1)", 0), "1");
    assert_eq!(float("(1<2?7:8)", 0), "7");
    assert_eq!(float("((1=1)&(2>3))", 0), "0");
    assert!(fault("#declare B = 1<2;").2.contains("`;`"));
    assert!(fault("#debug str((1=1)&(2>3), 0, 0)").2.contains('&'));
}

#[test]
fn nearly_equal_is_equal() {
    assert_eq!(float("(1 = 1+1e-11)", 0), "1");
    assert_eq!(float("(1e-11 ? 1 : 0)", 0), "0");
    assert_eq!(float("(0.3 >= 0.1+0.2)", 0), "1");
    assert_eq!(float("(0.1+0.2 > 0.3)", 0), "1");
}

#[test]
fn operands_are_promoted() {
    assert_eq!(vector(3, "<1,2,3>*<2,3>"), "2.0000,6.0000,0.0000");
    assert_eq!(vector(4, "<1,2>+<0,0,0,0>"), "1.0000,2.0000,0.0000,0.0000");
    assert_eq!(vector(4, "<0,0>+t"), "0.0000,0.0000,0.0000,1.0000");
    assert_eq!(vector(3, "<1,2,3>/<2,3,1>"), "0.5000,0.6667,3.0000");
}

#[test]
fn colours_come_in_many_forms() {
    let forms = [
        ("rgb 1+<0,0,0,0,0.5>", "1.0000,1.0000,1.0000,1.0000,1.5000"),
        ("color red 0.5 green 1 filter 0.2", "0.5000,1.0000,0.0000,0.2000,0.0000"),
        ("color 0.5", "0.5000,0.5000,0.5000,0.5000,0.5000"),
        ("color <0.2,0.4,0.6>", "0.2000,0.4000,0.6000,0.0000,0.0000"),
        ("rgbf <1,2,3,4>*0.5", "0.5000,1.0000,1.5000,2.0000,0.0000"),
        ("rgbt 0.5", "0.5000,0.5000,0.5000,0.0000,0.5000"),
        ("rgbt <0.1,0.2,0.3>", "0.1000,0.2000,0.3000,0.0000,0.0000"),
        ("rgbft <0.1,0.2,0.3,0.4,0.5>", "0.1000,0.2000,0.3000,0.4000,0.5000"),
        ("srgb <0.1,0.2,0.3>", "0.0100,0.0331,0.0732,0.0000,0.0000"),
        ("rgb <0.1,0.2,0.3> filter 0.3 transmit 0.2", "0.1000,0.2000,0.3000,0.3000,0.2000"),
        ("colour red 0.1", "0.1000,0.0000,0.0000,0.0000,0.0000"),
    ];
    for (text, expected) in forms {
        assert_eq!(vector(5, text), expected, "{text}");
    }
    let named = "#declare A = color red 0.5 green 1 filter 0.2; #declare B = ";
    let show = "; #debug vstr(5, B, \",\", 0, 2)";
    assert_eq!(debug(&format!("{named} color A*0.5 {show}")), "0.25,0.50,0.00,0.10,0.00");
    assert_eq!(debug(&format!("{named} color A filter 0.9 {show}")), "0.50,1.00,0.00,0.90,0.00");
    assert_eq!(debug(&format!("{named} A*<1,1,1> {show}")), "0.50,1.00,0.00,0.00,0.00");
    assert_eq!(debug(&format!("{named} x+A {show}")), "1.50,1.00,0.00,0.20,0.00");
    assert_eq!(debug(&format!("{named} rgb A {show}")), "0.50,1.00,0.00,0.20,0.00");
    assert_eq!(debug(&format!("{named} A.filter + A.red*10 + A.x; #debug str(B,0,2)")), "5.70");
}

#[test]
fn integers_are_cut_towards_zero() {
    assert_eq!(float("div(-7,2)", 0), "-3");
    assert_eq!(float("mod(-7,2)", 0), "-1");
    assert_eq!(float("int(-1.5)", 0), "-1");
    assert_eq!(float("floor(-1.5)", 0), "-2");
    assert_eq!(float("ceil(-1.5)", 0), "-1");
    assert_eq!(
        float("bitwise_and(6,3)", 0) + &float("bitwise_or(6,3)", 0) + &float("bitwise_xor(6,3)", 0),
        "275"
    );
}

#[test]
fn functions_of_floats_and_vectors() {
    assert_eq!(float("atan2(-1,-1)", 5), "-2.35619");
    assert_eq!(float("log(100)+degrees(pi)+radians(180)", 3), "185.142");
    assert_eq!(float("max(1,5,3)*10+min(4,2)", 0), "52");
    assert_eq!(float("select(-1,10,20)", 0), "10");
    assert_eq!(float("select(0,10,20)", 0), "20");
    assert_eq!(float("select(0,10,20,30)", 0), "20");
    assert_eq!(float("select(1,10,20,30)", 0), "30");
    assert_eq!(vector(3, "vrotate(x,y*90)"), "0.0000,0.0000,-1.0000");
    assert_eq!(vector(3, "vrotate(y,<90,0,90>)"), "0.0000,0.0000,1.0000");
    assert_eq!(vector(3, "vaxis_rotate(x,y,90)"), "0.0000,0.0000,-1.0000");
    assert_eq!(vector(3, "vcross(x,y)+vnormalize(<3,0,4>)"), "0.6000,0.0000,1.8000");
    assert_eq!(float("vdot(<1,2,3>,y)+vlength(<3,0,4>)", 0), "7");
}

#[test]
fn random_streams_are_the_languages_own() {
    let text = "#declare S = seed(42); #debug concat(str(rand(S),0,15), \" \", str(rand(S),0,15), \" \", str(rand(S),0,15))";
    assert_eq!(debug(text), "0.723582911240771 0.329979259597598 0.755761670357492");
    let text = "#declare S = seed(-1.7); #debug concat(str(rand(S),0,15), \" \", str(rand(S),0,15))";
    assert_eq!(debug(text), "0.578012873553208 0.446006170810667");
}

#[test]
fn strings_have_their_functions() {
    assert_eq!(
        debug(r#"#debug concat(str(1.5,8,3), "|", str(12,-5,1), "|", str(1e10,0,3))"#),
        "   1.500|012.0|10000000000.000"
    );
    assert_eq!(debug(r#"#debug vstr(3, <1,2,3>, ", ", 5, 1)"#), "  1.0,   2.0,   3.0");
    assert_eq!(
        debug(r#"#debug concat(substr("abcdef",2,3), strupr("aBc"), strlwr("aBc"), chr(65))"#),
        "bcdABCabcA"
    );
    assert_eq!(float(r#"strlen("abc")+asc("A")+val("1.5e2")"#, 0), "218");
    assert_eq!(float(r#"strcmp("a","b")"#, 0) + &float(r#"strcmp("b","a")"#, 0), "-11");
    assert_eq!(debug(r#"#declare S = "abc" #declare S = concat("x", S); #debug S"#), "xabc");
    assert_eq!(debug("#debug datetime(0)"), "2000-01-01 00:00:00Z");
}

#[test]
fn strings_are_compared() {
    for (condition, want) in [
        (r#""a" = "a""#, 1),
        (r#""a" != "a""#, 0),
        (r#""a" < "b""#, 1),
        (r#""b" <= "a""#, 0),
        (r#""b" > "a""#, 1),
        (r#""a" >= "a""#, 1),
        (r#"S = concat("a", "b")"#, 1),
        (r#"("a" = "a") & (S != "")"#, 1),
    ] {
        let text = format!("#declare S = \"ab\"; #if ({condition}) #debug \"1\" #else #debug \"0\" #end");
        assert_eq!(debug(&text), want.to_string(), "{condition}");
    }
    assert!(fault(r#"#if ("a" = 1) #end"#).2.contains("a string for a comparison"));
    assert!(fault(r#"#if ("a") #end"#).2.contains("a comparison of two strings"));
}

#[test]
fn what_has_no_value_is_said_at_its_place() {
    assert_eq!(fault("sphere { 0, 1/0 }"), (1, 13, "this expression is not a finite number (inf)".into()));
    assert!(fault("#declare A = <1,2,3>/<1,0,1>; sphere { A, 1 }").2.contains("finite"));
    assert!(fault("#declare A = mod(5, 0);").2.contains("division by zero"));
    assert!(fault("#declare A = sqrt(-1);").2.contains("square root"));
    assert!(fault("#declare A = ln(0);").2.contains("logarithm"));
    assert!(fault("#declare A = pow(-2, 0.5);").2.contains("finite"));
    assert!(fault("#declare A = 1e308*10; sphere { A, 1 }").2.contains("finite"));
    assert_eq!(fault("#declare A=5; #debug str(A.z, 0, 0)").2, "this value has no such part");
    assert_eq!(fault("#debug str(<1,2>.z, 0, 0)").2, "this value has no such part");
    assert!(fault("sphere { <1,2,3,4>, 1 }").2.contains("vector of three"));
    assert!(fault("#declare A = 2^3;").2.contains("pow(a, b)"));
    assert!(fault("#declare A = (1, 2);").2.contains("`)`"));
    assert!(fault("#declare A = rand(7);").2.contains("seed"));
}
