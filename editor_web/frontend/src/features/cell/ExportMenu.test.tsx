/** The scene of the cell is downloaded under the name of its document; a refusal is said. */
import { screen } from '@testing-library/react'
import { beforeEach, expect, it, vi } from 'vitest'
import { server, show } from '../../../testing/page'
import { Refusal } from '../../../testing/server'
import { ExportMenu } from './ExportMenu'

let saved: string[] = []

beforeEach(() => {
  saved = []
  vi.stubGlobal('URL', Object.assign(URL, { createObjectURL: () => 'blob:scene', revokeObjectURL: vi.fn() }))
  vi.spyOn(HTMLAnchorElement.prototype, 'click').mockImplementation(function (this: HTMLAnchorElement) {
    saved.push(this.download)
  })
})

it('downloads what was chosen, URDF as a ZIP file', async () => {
  const asked: string[] = []
  server().on('GET /cell/scene', ({ query }: { query: URLSearchParams }) => {
    asked.push(query.get('format') ?? '')
    return {}
  })
  const user = show(<ExportMenu file="press.yaml" />)
  for (const [label, name] of [
    ['glTF', 'press.glb'],
    ['MJCF', 'press.xml'],
    ['URDF', 'press.zip'],
  ] as const) {
    await user.click(screen.getByRole('button', { name: 'Export' }))
    await user.click(await screen.findByRole('menuitem', { name: new RegExp(label) }))
    expect(await screen.findByText(`Exported ${name}`)).toBeVisible()
  }
  expect(asked).toEqual(['glb', 'xml', 'urdf'])
  expect(saved).toEqual(['press.glb', 'press.xml', 'press.zip'])
})

it('says why there is no file', async () => {
  server().on('GET /cell/scene', new Refusal(409, { message: 'a scene is being exported already', hint: 'try again when it is there' }))
  const user = show(<ExportMenu file="press.yaml" />)
  await user.click(screen.getByRole('button', { name: 'Export' }))
  await user.click(await screen.findByRole('menuitem', { name: /glTF/ }))
  expect(await screen.findByText('a scene is being exported already – try again when it is there')).toBeVisible()
  expect(saved).toEqual([])
})
