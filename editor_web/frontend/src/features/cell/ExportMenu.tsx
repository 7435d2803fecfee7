/** Downloads the scene of the cell for other programs: glTF, MJCF, or URDF with its meshes. */
import { Button, Menu, Text } from '@mantine/core'
import { IconFileExport } from '@tabler/icons-react'
import { useState } from 'react'
import { sceneFile, type SceneFormat } from '../../api/cellScene'
import { wordsOf } from '../../api/client'
import { saveBlob } from '../../components/saveBlob'

const FORMATS: readonly (readonly [format: SceneFormat, label: string, suffix: string])[] = [
  ['glb', 'glTF, for viewers and Blender', 'glb'],
  ['xml', 'MJCF, for MuJoCo', 'xml'],
  ['urdf', 'URDF with meshes, for RViz and MoveIt', 'zip'],
]

/** `file` is the document of the cell. */
export function ExportMenu({ file }: { readonly file: string }) {
  const { now, take } = useScene(file)
  return (
    <>
      <Text span role="status" aria-label="Export" size="sm" c="dimmed">
        {now.words}
      </Text>
      <Menu position="bottom-end" shadow="md">
        <Menu.Target>
          <Button
            size="xs"
            variant="default"
            loading={now.isBusy}
            title="Download the saved cell for other programs"
            leftSection={<IconFileExport size={14} aria-hidden />}
          >
            Export
          </Button>
        </Menu.Target>
        <Menu.Dropdown>
          {FORMATS.map(([format, label, suffix]) => (
            <Menu.Item key={format} onClick={() => void take(format, suffix)}>
              {label}
            </Menu.Item>
          ))}
        </Menu.Dropdown>
      </Menu>
    </>
  )
}

function useScene(file: string) {
  const [now, setNow] = useState({ isBusy: false, words: '' })
  const take = async (format: SceneFormat, suffix: string) => {
    const name = `${file.replace(/\.[^.]*$/, '')}.${suffix}`
    setNow({ isBusy: true, words: '' })
    try {
      saveBlob(await sceneFile(format), name)
      setNow({ isBusy: false, words: `Exported ${name}` })
    } catch (error) {
      setNow({ isBusy: false, words: wordsOf(error) })
    }
  }
  return { now, take }
}
