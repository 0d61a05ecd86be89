# Installs okoshi's extension into Inkscape on Windows: powershell -ExecutionPolicy Bypass -File install.ps1
# -Okoshi PATH is the program, -Folder DIR Inkscape's folder of extensions; -Uninstall removes the extension.
param([string]$Okoshi = $env:OKOSHI, [string]$Folder, [switch]$Uninstall)
$ErrorActionPreference = 'Stop'

# inkscape.com is the one that writes to a console.
$inkscape = @('inkscape.com', "$env:ProgramFiles\Inkscape\bin\inkscape.com") |
    ForEach-Object { Get-Command $_ -ErrorAction SilentlyContinue } | Select-Object -First 1
if ($inkscape) {
    $version = (& $inkscape.Source --version | Select-Object -First 1)
    if ($version -notmatch '^Inkscape [1-9]') { throw "This is $version; the extension needs Inkscape 1.0 or newer." }
    Write-Output "${version}: $($inkscape.Source)"
    if (-not $Folder) { $Folder = Join-Path (& $inkscape.Source --user-data-directory | Select-Object -Last 1) 'extensions' }
}
if (-not $Folder) { $Folder = Join-Path $env:APPDATA 'inkscape\extensions' }
$target = Join-Path $Folder 'okoshi'
# Starter drawings, which Inkscape offers under New from Template.
$templates = Join-Path (Split-Path $Folder) 'templates\okoshi'

if ($Uninstall) {
    if (Test-Path $templates) { Remove-Item -Recurse -Force $templates }
    if (Test-Path $target) { Remove-Item -Recurse -Force $target; Write-Output "removed: $target" }
    else { Write-Output "nothing to remove: there is no $target" }
    exit 0
}

if (-not $Okoshi) { $Okoshi = 'okoshi' }
$program = @($Okoshi, "$env:USERPROFILE\.cargo\bin\okoshi.exe") |
    ForEach-Object { Get-Command $_ -ErrorAction SilentlyContinue } | Select-Object -First 1
if (-not $program) { throw 'The program okoshi was not found. Install one of its packages (pip install okoshi-*.whl, for instance), or pass its path: -Okoshi C:\path\to\okoshi.exe' }
$said = (& $program.Source --version)
if ($said -notmatch '^okoshi ') { throw "$($program.Source) is not okoshi: its version is `"$said`"." }
Write-Output "${said}: $($program.Source)"

if (Test-Path $target) { Remove-Item -Recurse -Force $target }
New-Item -ItemType Directory -Force $target | Out-Null
Copy-Item (Join-Path $PSScriptRoot 'extension\*.inx'), (Join-Path $PSScriptRoot 'extension\*.py') $target
[IO.File]::WriteAllText((Join-Path $target 'okoshi.path'), "$($program.Source)`n")
Write-Output "installed: $target"
# An older program has no list.
$list = (& $program.Source new --list 2>$null)
if ($LASTEXITCODE -eq 0) {
    if (Test-Path $templates) { Remove-Item -Recurse -Force $templates }
    New-Item -ItemType Directory -Force $templates | Out-Null
    foreach ($line in $list) {
        $name = ($line -split ' ')[0]
        & $program.Source new --quiet (Join-Path $templates $name) --template $name
    }
    Write-Output "installed: $templates"
}
Write-Output 'Restart Inkscape. Then File > Save As offers glTF, and the menu Extensions has Okoshi; File > New from Template offers the starter drawings.'
