/** What can be done with the behavior as a file: versions, another name, a copy, a picture, deleting. */
import { ActionIcon, Menu } from '@mantine/core'
import {
  IconCopy,
  IconCursorText,
  IconDots,
  IconFileTypePdf,
  IconFileTypePng,
  IconFileTypeSvg,
  IconHistory,
  IconTrash,
} from '@tabler/icons-react'
import { exportPicture } from './exporting'
import { openFileDialog } from './fileDialogs'

export function FileMenu({ mayEdit }: { mayEdit: boolean }) {
  return (
    <Menu position="bottom-end" shadow="md" width={230} returnFocus>
      <Menu.Target>
        <ActionIcon variant="default" size={30} aria-label="File" title="Versions, rename, copy, picture, delete">
          <IconDots size={16} aria-hidden />
        </ActionIcon>
      </Menu.Target>
      <Menu.Dropdown>
        <Menu.Item leftSection={<IconHistory size={15} aria-hidden />} onClick={() => openFileDialog('versions')}>
          Versions…
        </Menu.Item>
        <Menu.Divider />
        <Menu.Item leftSection={<IconFileTypeSvg size={15} aria-hidden />} onClick={() => void exportPicture('svg')}>
          Export as SVG
        </Menu.Item>
        <Menu.Item leftSection={<IconFileTypePng size={15} aria-hidden />} onClick={() => void exportPicture('png')}>
          Export as PNG
        </Menu.Item>
        <Menu.Item leftSection={<IconFileTypePdf size={15} aria-hidden />} onClick={() => void exportPicture('pdf')}>
          Export as PDF
        </Menu.Item>
        <Menu.Divider />
        <Menu.Item disabled={!mayEdit} leftSection={<IconCursorText size={15} aria-hidden />} onClick={() => openFileDialog('rename')}>
          Rename or move…
        </Menu.Item>
        <Menu.Item disabled={!mayEdit} leftSection={<IconCopy size={15} aria-hidden />} onClick={() => openFileDialog('duplicate')}>
          Duplicate…
        </Menu.Item>
        <Menu.Item
          disabled={!mayEdit}
          color="red"
          leftSection={<IconTrash size={15} aria-hidden />}
          onClick={() => openFileDialog('delete')}
        >
          Delete…
        </Menu.Item>
      </Menu.Dropdown>
    </Menu>
  )
}
