//! Files that a scene opens by itself.

mod support;

use durer_pov::ReadOptions;
use support::{Folder, debug, fault, read};

#[test]
fn what_is_written_can_be_read_again() {
    let text = r#"#fopen F "a.txt" write
        #write (F, "1, -2.5, ", <1, 2/3, -3>, ",", "\"three, four\"", "\n")
        #fclose F
        #fopen F "a.txt" append #write (F, ", 7") #fclose F
        #fopen F "a.txt" read
        #declare Seen = array[2]
        #read (F, A, Seen[1], V, S)
        #debug concat(str(A, 0, 1), " ", str(Seen[1], 0, 1), " ", vstr(3, V, " ", 0, 3), " ", S)
        #debug str(defined(F), 0, 0)
        #read (F, Last)
        #debug concat(str(Last, 0, 0), str(defined(F), 0, 0), str(file_exists("a.txt"), 0, 0))
        #fclose F"#;
    assert_eq!(debug(text), "1.0 -2.5 1.000 0.667 -3.000 three, four1701");
    let written = read(text).unwrap().written;
    assert_eq!(written.len(), 1);
    assert!(written[0].path.ends_with("a.txt"));
    assert_eq!(written[0].text, "1, -2.5, <1,0.666667,-3> ,\"three, four\"\n, 7");
}

#[test]
fn a_written_file_can_be_included_and_written_anew() {
    let text = r##"#for (I, 1, 3)
            #fopen F "part.inc" write #write (F, "#declare A = ", I, ";\n") #fclose F
            #include "part.inc"
            #debug str(A, 0, 0)
        #end"##;
    assert_eq!(debug(text), "123");
}

#[test]
fn reading_a_scene_changes_nothing_outside() {
    let folder = Folder::new();
    folder.write("scene.pov", "#fopen F \"made.txt\" write #write (F, 1) #fclose F sphere { 0, 1 }");
    let read = folder.read("scene.pov").unwrap();
    assert_eq!(read.written[0].path, folder.0.join("made.txt"));
    assert!(!folder.0.join("made.txt").exists());
    let elsewhere = ReadOptions { write_folder: Some(folder.0.join("out")), ..ReadOptions::default() };
    let read = durer_pov::read(&folder.0.join("scene.pov"), &elsewhere).unwrap();
    assert_eq!(read.written[0].path, folder.0.join("out/made.txt"));
}

#[test]
fn files_stay_in_their_folder() {
    for name in ["../x", "/tmp/x", "a/../../x", "..\\\\x"] {
        let (_, _, said) = fault(&format!("#fopen F \"{name}\" write"));
        assert!(said.contains("must be a relative path without `..`"), "{name}: {said}");
    }
    let folder = Folder::new();
    folder.write("scene.pov", "#fopen F \"../x\" write #fclose F sphere { 0, 1 }");
    let options = ReadOptions { any_file: true, ..ReadOptions::default() };
    assert!(durer_pov::read(&folder.0.join("scene.pov"), &options).is_ok());
}

#[test]
fn wrong_files_are_refused_in_words() {
    for (text, part) in [
        ("#fopen F \"nowhere.txt\" read", "there is no file \"nowhere.txt\""),
        ("#fopen F \"a\" delete", "opened to read, write or append"),
        ("#fopen F \"\" write", "needs a name"),
        ("#fopen F \"a\" write #read (F, A)", "not open for reading"),
        ("#declare F = 1; #write (F, 2)", "`F` is no open file"),
        (
            "#fopen F \"a\" write #write (F, \"sphere\") #fclose F #fopen F \"a\" read #read (F, A)",
            "a number, vector or string is read from here",
        ),
        (
            "#fopen F \"a\" write #write (F, \"1\") #fclose F #fopen F \"a\" read #read (F, A, B)",
            "has no more values",
        ),
        ("#fopen F \"a\" write #while (1) #write (F, \"0123456789\") #end", "the limit"),
        ("#for (I, 1, 100) #fopen F \"a\" write #end", "at most 64 files open"),
    ] {
        let (_, _, said) = fault(text);
        assert!(said.contains(part), "{text}: {said}");
    }
}
