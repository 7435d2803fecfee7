/** Puts the page into the document. */
import '@fontsource-variable/inter/wght.css'
import '@mantine/core/styles.css'
import './styles/base.css'
import './styles/status.css'
import './styles/frame.css'
import './styles/panels.css'
import './styles/forms.css'
import './styles/graph.css'
import './styles/outline.css'
import './styles/log.css'
import './styles/control.css'
import './styles/robots.css'
import './styles/small.css'
import { MantineProvider } from '@mantine/core'
import { createRoot } from 'react-dom/client'
import { App } from './App'
import { theme } from './theme'

const root = document.getElementById('root')
if (!root) throw new Error('index.html has no #root')
createRoot(root).render(
  <MantineProvider theme={theme} defaultColorScheme="auto">
    <App />
  </MantineProvider>,
)
