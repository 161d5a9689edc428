//! Directives, macros, includes: facts observed in POV-Ray 3.7.

mod support;

use durer_pov::{ErrorKind, MessageKind, ReadOptions};
use support::{Folder, debug, fault, notices, read};

#[test]
fn a_name_is_passed_by_reference_an_expression_by_value() {
    assert_eq!(debug("#macro F(A) #declare A=A+1; #end #declare Q=1; F(Q) #debug str(Q,0,0)"), "2");
    assert_eq!(debug("#macro F(A) #local A=9; #end #declare Q=1; F(Q) #debug str(Q,0,0)"), "9");
    assert_eq!(debug("#macro F(A) #declare A=A+1; #end #declare Q=1; F(Q+0) #debug str(Q,0,0)"), "1");
    let element = "#declare A=array[2]{1,2} #macro F(P) #declare P=7; #end F(A[1]) #debug str(A[1],0,0)";
    assert_eq!(debug(element), "7");
    let through = "#macro G(B) #declare B=5; #end #macro F(A) G(A) #end #declare Q=1; F(Q) #debug str(Q,0,0)";
    assert_eq!(debug(through), "5");
    assert!(fault("#macro F(A) #end F(Nothing)").2.contains("undeclared `Nothing`"));
}

#[test]
fn a_macro_may_be_any_tokens() {
    assert_eq!(debug("#macro G(A,B) A*B #end #debug str(G(2,3)+1,0,0)"), "7");
    assert_eq!(debug("#macro V(a,b) <a,b,0> #end #debug vstr(3,V(1 2)*2+x,\",\",0,0)"), "3,4,0");
    assert_eq!(debug("#macro F(N) #if (N>1) N*F(N-1) #else 1 #end #end #debug str(F(5),0,0)"), "120");
    let read = read("#macro Half() sphere { 0, #end Half() 1 }").unwrap();
    assert_eq!(read.scene.objects.len(), 1);
}

#[test]
fn a_declare_changes_the_innermost_variable_of_its_name() {
    let text = "#macro G() #declare L=2; #end #macro F() #local L=1; G() #debug str(L,0,0) #end F()
        #ifdef (L) #debug \" global\" #else #debug \" gone\" #end";
    assert_eq!(debug(text), "2 gone");
    let text = "#declare L=1; #macro F() #local L=5; #end F() #debug str(L,0,0)";
    assert_eq!(debug(text), "1");
}

#[test]
fn a_macro_may_end_while_its_value_is_declared() {
    let text = "#macro T() texture { pigment { rgb 1 } } #local Z=1; #end #macro F() #local A = T() #local B = 3; #debug str(B,0,0) #end F()";
    assert_eq!(debug(text), "3");
    assert_eq!(debug("#macro C() (1=1) #end #if (C()) #debug \"yes\" #end"), "yes");
}

#[test]
fn loops_count_as_the_language_does() {
    assert_eq!(debug("#for (K,0,5) #debug str(K,0,0) #declare K=K+1; #end"), "024");
    assert_eq!(debug("#for (K,3,1,-1) #debug str(K,0,0) #end"), "321");
    assert_eq!(debug("#for (K,3,1) #debug str(K,0,0) #end #debug \".\""), ".");
    assert_eq!(debug("#for (K,1,0.7,-0.1) #debug concat(str(K,0,1),\" \") #end"), "1.0 0.9 0.8 0.7 ");
    assert_eq!(debug("#for (K,0,0.3,0.1) #debug concat(str(K,0,1),\" \") #end"), "0.0 0.1 0.2 0.3 ");
    assert_eq!(debug("#for (K,0,1,0.5) #end #debug str(K,0,1)"), "1.5");
    assert_eq!(debug("#local i=0; #while (i<3) #local i=i+1; #end #debug str(i,0,0)"), "3");
    assert!(fault("#for (I,1,3,0) #end").2.contains("zero"));
}

#[test]
fn a_switch_falls_through_until_a_break() {
    let text = "#declare i=0; #while (i<5) #switch (i) #case (1) #debug \"a\" #case (2) #debug \"b\" #break
        #range (3,4) #debug \"c\" #break #else #debug \"e\" #end #declare i=i+1; #end";
    assert_eq!(debug(text), "eabbcc");
    assert_eq!(debug("#while (1) #debug \"once\" #if (1) #break #end #end"), "once");
    assert_eq!(debug("#switch (1+1e-11) #case (1) #debug \"eq\" #break #else #debug \"ne\" #end"), "eq");
    assert_eq!(
        debug("#for (I,1,3) #switch (I) #case (2) #debug \"two\" #break #end #debug \".\" #end"),
        ".two.."
    );
}

#[test]
fn conditions_stand_anywhere() {
    let text = "#declare A = 1; sphere { <0, #if (A) 1 #else 2 #end, 0>, #ifdef (B) 2 #else 3 #end #ifndef (B) translate x #end }";
    assert_eq!(read(text).unwrap().scene.objects.len(), 1);
    assert_eq!(
        debug(
            "#if (0) #debug \"a\" #elseif (1) #debug \"b\" #elseif (1) #debug \"c\" #else #debug \"d\" #end"
        ),
        "b"
    );
    assert!(fault("#if (1=1) & (1=2) #end").2.contains('&'));
}

#[test]
fn arrays_have_sizes_and_holes() {
    let text = "#declare A=array[2][3]{{1,2,3},{4,5,6}} #debug concat(str(A[1][2],0,0),str(dimension_size(A,2),0,0),str(dimensions(A),0,0))";
    assert_eq!(debug(text), "632");
    let text =
        "#declare A=array[3]; #debug concat(str(defined(A[0]),0,0),str(defined(A),0,0),str(defined(Z),0,0))";
    assert_eq!(debug(text), "010");
    assert_eq!(debug("#declare A=array[2]{1,2} #declare B=A; #declare B[1]=4; #debug str(A[1],0,0)"), "2");
    assert_eq!(debug("#declare C=array[2]{array[1]{2},array[1]{3}} #debug str(C[1][0],0,0)"), "3");
    assert_eq!(debug("#declare C=array[2]{<1,2,3>,<4,5,6>,} #debug str(C[1.7].y,0,0)"), "5");
    assert!(fault("#declare A=array[2]; #debug str(A[0],0,0)").2.contains("no value"));
    assert!(fault("#declare A=array[2]{1,2} #debug str(A[2],0,0)").2.contains("outside"));
    assert!(fault("#declare A=array[2]{1,2} #debug str(A[-1],0,0)").2.contains("outside"));
}

#[test]
fn undef_and_defined() {
    assert_eq!(notices("#undef Nope"), ["#undef of `Nope`, which is not declared"]);
    assert_eq!(debug("#declare A=1; #undef A #ifdef (A) #debug \"a\" #else #debug \"b\" #end"), "b");
    assert_eq!(debug("#declare A=array[2]{1,2} #undef A[1] #debug str(defined(A[1]),0,0)"), "0");
}

#[test]
fn numbers_need_a_semicolon_blocks_do_not() {
    assert!(fault("#declare X=3 #declare Y=2;").2.contains("`;`"));
    assert!(
        read("#declare X=sphere{0,1} #declare Y=X; #declare Z=texture{pigment{rgb 1}}; object{Y}").is_ok()
    );
    let (line, column, text) = fault("#declare sphere = 3;");
    assert_eq!((line, column), (1, 10));
    assert!(text.contains("`sphere` is a word of the language"), "{text}");
}

#[test]
fn includes_are_found_whatever_their_case() {
    let folder = Folder::new();
    folder.write("Sub/PARTS.INC", "#local Hidden=1; #declare Radius=2;");
    folder.write(
        "scene.pov",
        "#include \"sub\\parts.inc\" #debug str(Radius,0,0) #ifdef (Hidden) #debug \"!\" #end",
    );
    let read = folder.read("scene.pov").unwrap();
    assert_eq!(read.messages.iter().map(|m| m.text.as_str()).collect::<String>(), "2");
}

#[test]
fn library_folders_and_declares_come_from_the_options() {
    let folder = Folder::new();
    folder.write("lib/mine.inc", "#declare R=Width*2+clock;");
    let path = folder
        .write("scene.pov", "#include \"mine.inc\" #debug concat(str(R,0,1),\" \",str(image_width,0,0))");
    let options = ReadOptions {
        library_paths: vec![folder.0.join("lib")],
        declares: vec![("Width".into(), 3.0)],
        clock: 0.5,
        image_width: 320,
        ..ReadOptions::default()
    };
    let mut heard = String::new();
    durer_pov::read_with(&path, &options, |message| heard += &message.text).unwrap();
    assert_eq!(heard, "6.5 320");
    let options = ReadOptions { declares: vec![("sphere".into(), 3.0)], ..ReadOptions::default() };
    assert!(durer_pov::read(&path, &options).unwrap_err().text.contains("cannot be declared"));
}

#[test]
fn version_is_in_force_from_where_it_stands() {
    assert_eq!(debug("#version 3.5; #debug str(version,0,2)"), "3.50");
    assert_eq!(debug("#version unofficial 3.6; #debug str(version,0,1)"), "3.6");
    assert_eq!(debug("#if (1) #version 3.6 #end #debug str(version,0,1)"), "3.6");
    let error = read("#version 3.8;").unwrap_err();
    assert_eq!(error.kind, ErrorKind::Unsupported);
}

#[test]
fn messages_are_kept_in_their_order() {
    let read = read("#debug \"a\" #warning \"b\" #debug \"c\"").unwrap();
    let said: Vec<_> = read.messages.iter().map(|m| (m.kind, m.text.as_str())).collect();
    let expected = [(MessageKind::Debug, "a"), (MessageKind::Warning, "b"), (MessageKind::Debug, "c")];
    assert_eq!(said, expected);
    let error = support::read("#error concat(\"by\", \"e\")").unwrap_err();
    assert_eq!((error.kind, error.text.as_str()), (ErrorKind::Raised, "#error: bye"));
}

#[test]
fn warnings_that_repeat_themselves_are_counted() {
    let texts = |source: &str| -> Vec<String> {
        read(source).unwrap().messages.into_iter().map(|m| m.text).collect()
    };
    assert_eq!(
        texts("#for (I, 1, 5000) #warning \"again\\n\" #end #debug \"x\""),
        ["again\n", "x", "again (said 5000 times)"]
    );
    // Two places that alternate are two warnings.
    assert_eq!(
        texts("#for (I, 1, 3) #warning \"a\" #warning \"b\" #end"),
        ["a", "b", "a (said 3 times)", "b (said 3 times)"]
    );
    // Changing warnings are reported up to a limit; `#debug` output always is.
    assert_eq!(
        texts("#for (I, 1, 4) #warning str(div(I, 3), 0, 0) #end"),
        ["0", "0 (said 2 times)", "1", "1 (said 2 times)"]
    );
    let many = texts("#for (I, 1, 5000) #warning str(I, 0, 0) #end");
    assert_eq!(
        (many.len(), many[999].as_str(), many[1000].as_str()),
        (1001, "1000", "4000 more warnings from here are not shown")
    );
    assert_eq!(texts("#for (I, 1, 3) #debug \".\" #end"), [".", ".", "."]);
    // The messages are kept even if the scene fails.
    let (folder, mut said) = (Folder::new(), Vec::new());
    let file = folder.write("scene.pov", "#while (1) #warning \"again\" #end");
    let failed = durer_pov::read_with(&file, &ReadOptions::default(), |m| said.push(m.text.clone()));
    assert!(failed.is_err() && said.len() == 2 && said[1].starts_with("again (said "), "{said:?}");
}

#[test]
fn what_cannot_be_done_yet_may_be_defined_but_not_used() {
    let defined = "#declare S = spline { linear_spline 0,x 1,y }
        #declare M = texture { pigment { spacing color_map { [0 rgb 0][1 rgb 1] } } normal { spacing } } texture { pigment { marble } }
        #declare P = pigment { spacing turbulence 0.5 } #declare N = normal { spacing }
        #macro W() spacing #end #declare After = 7; #debug str(After,0,0)";
    assert_eq!(debug(defined), "7");
    for (use_it, word) in [
        ("sphere { 0, 1 texture { M } }", "spacing"),
        ("sphere { 0, 1 pigment { P } }", "spacing"),
        ("sphere { 0, 1 normal { N } }", "spacing"),
        ("sphere { 0, W() }", "spacing"),
    ] {
        let error = read(&format!("{defined}\n{use_it}")).unwrap_err();
        assert_eq!(error.text, format!("not supported yet: {word}"), "{use_it}");
        assert_eq!(error.kind, ErrorKind::Unsupported);
    }
}
