;;; test.el --- Drives the language server from a real Emacs  -*- lexical-binding: t; -*-

;;; Commentary:

;;     OKOSHI=target/debug/okoshi emacs -q --batch -L editors/emacs -l editors/emacs/test.el -f ert-run-tests-batch-and-exit

;;; Code:

(require 'ert)
(require 'flymake)
(require 'okoshi)

(defconst test-root (expand-file-name "../.." (file-name-directory (or load-file-name buffer-file-name))))
(defconst test-arm "Rarm@Ubody$Shape roundv -90 90")

(setq okoshi-command (list (or (getenv "OKOSHI") (error "OKOSHI names the program to test")) "lsp"))
(setq eglot-sync-connect 60
      eglot-autoshutdown nil
      eglot-send-changes-idle-time 0.05
      flymake-no-changes-timeout 0.05
      create-lockfiles nil
      make-backup-files nil)

(defun test-wait (about condition)
  "Wait until CONDITION holds; ABOUT says what that is."
  (let ((end (+ (float-time) 60)) value)
    (while (not (or (setq value (funcall condition)) (> (float-time) end)))
      (accept-process-output nil 0.02))
    (unless value (ert-fail (format "waited in vain until %s" about)))
    value))

(defun test-example (name)
  "The text of the example NAME."
  (with-temp-buffer
    (insert-file-contents (expand-file-name (concat "examples/" name) test-root))
    (buffer-string)))

(defun test-with (text old new)
  "TEXT with NEW in the place of OLD."
  (should (string-match (regexp-quote old) text))
  (replace-match new t t text))

(defun test-part (server)
  "Take leave of SERVER, which must end by itself and well."
  (let ((process (jsonrpc--process server)))
    (setf (eglot--shutdown-requested server) t)
    (jsonrpc-request server :shutdown nil)
    (jsonrpc-notify server :exit nil)
    (test-wait "the server has ended" (lambda () (not (or (process-live-p process) eglot--managed-mode))))
    (should (equal (process-exit-status process) 0))))

(defmacro test-in (text &rest body)
  "Open TEXT as a drawing in a folder of its own, and run BODY there."
  (declare (indent 1))
  `(let* ((folder (file-name-as-directory (file-truename (make-temp-file "okoshi" t))))
          (file (concat folder "drawing.svg")))
     (unwind-protect
         (progn
           (let ((coding-system-for-write 'utf-8-unix)) (write-region ,text nil file nil 'quiet))
           ;; `image-mode' detects by an error that there is no display; ERT would stop there.
           (with-current-buffer (let ((debug-on-error nil)) (find-file-noselect file))
             (should (derived-mode-p 'nxml-mode))
             ;; In batch mode no command ever ends, which is when Eglot would start.
             (should (memq 'okoshi-ensure nxml-mode-hook))
             (apply #'eglot (eglot--guess-contact))
             (test-wait "Eglot manages the buffer" (lambda () eglot--managed-mode))
             (should (cl-typep (eglot-current-server) 'okoshi-server))
             (unwind-protect (progn ,@body)
               (test-part (eglot-current-server))
               (set-buffer-modified-p nil)
               (kill-buffer))))
       (delete-directory folder t))))

(defun test-go (words &optional offset)
  "Go OFFSET characters behind the start of WORDS."
  (goto-char (point-min))
  (search-forward words)
  (goto-char (+ (match-beginning 0) (or offset 0))))

(defun test-shown ()
  "The diagnostics that Flymake shows: severity, words, message."
  (mapcar (lambda (diagnostic)
            (list (flymake-diagnostic-type diagnostic)
                  (buffer-substring-no-properties (flymake-diagnostic-beg diagnostic) (flymake-diagnostic-end diagnostic))
                  (flymake-diagnostic-text diagnostic)))
          (sort (copy-sequence (flymake-diagnostics))
                (lambda (a b) (< (flymake-diagnostic-beg a) (flymake-diagnostic-beg b))))))

(defun test-look ()
  "Do what happens by itself while a person looks on: idle timers, which do not run in batch mode."
  (eglot--signal-textDocument/didChange)
  (flymake-start))

(defun test-shows (words message)
  "Wait until MESSAGE is shown at WORDS."
  (test-wait (format "`%s' is told at `%s'" message words)
             (lambda ()
               (test-look)
               (cl-some (lambda (found)
                          (and (equal (nth 1 found) words) (string-search message (nth 2 found))))
                        (test-shown)))))

(defun test-ask (method &rest more)
  "The answer to METHOD at point, with MORE parameters."
  (eglot--signal-textDocument/didChange)
  (jsonrpc-request (eglot-current-server) method (append (eglot--TextDocumentPositionParams) more)))

(ert-deftest diagnostics-come-through-flymake ()
  (test-in (test-with (test-example "human.svg") "Larm@Ubody" "Larm@Ubodi")
    (test-shows "Ubodi" "there is no part named `Ubodi`: did you mean `Ubody`?")
    (should (equal (mapcar #'car (test-shown)) '(eglot-note eglot-note eglot-error)))
    (should (equal (mapcar #'cadr (test-shown)) '("<path" "<path" "Ubodi")))))

(ert-deftest edits-are-told ()
  (test-in (test-example "human.svg")
    (test-go test-arm 8)
    (insert "😀右")
    (test-shows "Ubo😀右dy" "there is no part named")
    (delete-char -2)
    (test-wait "the fault is gone" (lambda () (test-look) (= 2 (length (test-shown)))))))

(ert-deftest hover-tells-of-a-string ()
  (test-in (test-example "human.svg")
    (test-go test-arm 18)
    (let ((hover (test-ask :textDocument/hover)))
      (should (string-search "**Shape roundv**" (plist-get (plist-get hover :contents) :value))))
    (test-go test-arm 1)
    (let (told)
      (eglot-hover-eldoc-function (lambda (text &rest _) (setq told text)))
      (test-wait "ElDoc has the hover" (lambda () told))
      (should (string-search "Root › Ubody › **Rarm**" (substring-no-properties told))))))

(ert-deftest completion-at-point-writes-what-may-follow ()
  (dolist (case '(("Rarm@Ub" "Ub" "Ubody" "Rarm@Ubody$Shape roundv")
                  ("Rarm@Ub$Sha" "Sha" "Shape" "Rarm@Ub$Shape roundv")))
    (pcase-let ((`(,before ,typed ,word ,after) case))
      (test-in (test-with (test-example "human.svg") test-arm (concat before (if (string-search "$" before) "" "$Shape") " roundv"))
        (test-go before (length before))
        (let* ((capf (eglot-completion-at-point))
               (found (all-completions typed (nth 2 capf))))
          (should (equal (buffer-substring-no-properties (nth 0 capf) (nth 1 capf)) typed))
          (should (equal (mapcar #'substring-no-properties found) (list word))))
        (completion-at-point)
        (should (string-search (format ">%s<" after) (buffer-string)))))))

(ert-deftest rename-is-applied-to-all-strings ()
  (test-in (test-example "human.svg")
    (let ((before (buffer-string)))
      (test-go test-arm 6)
      (eglot-rename "上半身")
      (should (= 4 (how-many "上半身" (point-min) (point-max))))
      (should (= 0 (let ((case-fold-search nil)) (how-many "Ubody" (point-min) (point-max)))))
      (test-look)
      (test-go "Rarm@上半身" 6)
      (eglot-rename "Ubody")
      (should (equal (buffer-string) before)))))

(ert-deftest formatting-touches-strings-alone ()
  (test-in (test-with (test-example "human.svg") test-arm "Rarm  @ Ubody$Shape   roundv -90   90")
    (eglot-format-buffer)
    (should (equal (buffer-string) (test-example "human.svg")))))

(ert-deftest definition-is-found-by-xref ()
  (test-in (test-example "human.svg")
    (test-go test-arm 6)
    (let* ((found (xref-backend-definitions 'eglot "Ubody"))
           (place (xref-location-marker (if (fboundp 'xref-item-location) (xref-item-location (car found))))))
      (should (= 1 (length found)))
      (goto-char place)
      (should (looking-at-p "Ubody</tspan>")))))

(ert-deftest a-fix-is-applied ()
  (test-in (test-with (test-example "human.svg") "Larm@Ubody" "Larm@Ubodi")
    (test-shows "Ubodi" "there is no part named")
    (test-go "Ubodi" 2)
    (let* ((actions (eglot-code-actions (point) (point) "quickfix"))
           (fix (cl-find "Write `Ubody`" actions :key (lambda (action) (plist-get action :title)) :test #'equal)))
      (should fix)
      (eglot--apply-workspace-edit (plist-get fix :edit)))
    (should (equal (buffer-string) (test-example "human.svg")))
    (test-wait "the fault is gone" (lambda () (test-look) (= 2 (length (test-shown)))))))

(ert-deftest the-hierarchy-is-in-imenu ()
  (test-in (test-example "human.svg")
    (let ((names (flatten-tree (eglot-imenu))))
      (dolist (name '("Ubody" "Head" "Rarm" "Larm" "Lbody" "U-1" "U-2"))
        (should (cl-member name names :test (lambda (a b) (and (stringp b) (string-match-p (concat "\\b" a "\\'") b)))))))))

(ert-deftest preview-leads-to-a-page ()
  (test-in (test-example "human.svg")
    (let (told)
      (cl-letf (((symbol-function 'message) (lambda (form &rest more) (push (apply #'format form more) told))))
        (okoshi-preview)
        (let ((line (test-wait "the page is told of"
                               (lambda () (cl-find-if (lambda (words) (string-search "the preview is at" words)) told)))))
          (should (string-match "at \\(http://127\\.0\\.0\\.1:[0-9]+/\\)#.*svg\\'" line))
          (with-current-buffer (url-retrieve-synchronously (match-string 1 line) t)
            (should (string-search "<title>okoshi preview</title>" (buffer-string)))))))))

(ert-deftest other-xml-is-left-alone ()
  (let ((file (make-temp-file "okoshi" nil ".xml" "<notes/>\n")))
    (unwind-protect
        (with-current-buffer (find-file-noselect file)
          (should (derived-mode-p 'nxml-mode))
          (should-not (local-variable-p 'eglot-server-programs))
          (kill-buffer))
      (delete-file file))))

;;; test.el ends here
