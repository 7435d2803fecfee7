import { expect, test } from 'vitest'
import { fileProblem, idOfFile, partsOfId } from './fileNames'

test('an id comes apart and together again', () => {
  for (const id of ['behaviors/a.yaml', 'behaviors/x/y z/a.b.yml', 'behaviors/x/a.json']) {
    const { folder, name, ending } = partsOfId(id)
    expect(idOfFile(folder, name, ending)).toBe(id)
  }
  expect(partsOfId('behaviors/x/y/a.b.yml')).toEqual({ folder: 'x/y', name: 'a.b', ending: '.yml' })
})

test('names that no file can have are refused before the server is asked', () => {
  expect(fileProblem('', 'night')).toBeUndefined()
  expect(fileProblem('/a/b/', 'night shift')).toBeUndefined()
  for (const [folder, name] of [
    ['', ''],
    ['', '../x'],
    ['', '-x'],
    ['a/../b', 'x'],
    ['', 'a.breakpoints'],
    ['', 'a/b'],
  ])
    expect(fileProblem(folder ?? '', name ?? '')).toBeTruthy()
})
